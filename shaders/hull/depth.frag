// Depth of a billboard, which has no normal.
layout(location = 0) in vec3 in_camera;
layout(location = 0) out float depth;
layout(location = 1) out vec4 normal;

void main()
{
    depth = in_camera.z;
    normal = vec4(0.0, 0.0, 0.0, 1.0);
}
