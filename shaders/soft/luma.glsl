// Luma (ITU-R BT.601) of a colour in sRGB.
float luma_of(vec3 color)
{
    return dot(color, vec3(0.299, 0.587, 0.114));
}
