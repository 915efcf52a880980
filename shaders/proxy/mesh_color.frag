// The colours of a mesh's vertices, as pixel_blended's with weight 1.
layout(location = 1) in vec3 light;
layout(location = 0) out vec4 pixel;

void main()
{
    pixel = vec4(light, 1.0);
}
