// The nearest point of each pixel.
flat in vec4 splat;
flat in uint normal;
flat in vec3 color;
layout(location = 0) out vec4 splat_out;  // depth, radius, displacement from the pixel's centre
layout(location = 1) out uint normal_out; // octahedral
layout(location = 2) out vec4 color_out;  // sRGB

void main()
{
    splat_out = splat;
    normal_out = normal;
    color_out = vec4(color, 1.0);
}
