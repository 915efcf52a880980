// Plain points of one pixel, for comparison with compute splatting (src/gpu/point_raster.c).
layout(std140, binding = 0) uniform Matrix {
    mat4 clip_from_world;
};
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 out_color;

void main()
{
    gl_Position = clip_from_world * vec4(position, 1.0);
    gl_PointSize = 1.0;
    out_color = color;
}
