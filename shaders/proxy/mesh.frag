// Depth, and the triangle's own normal, towards the viewer.
layout(location = 0) in vec3 in_camera;
layout(location = 0) out float depth;
layout(location = 1) out vec4 normal;

void main()
{
    vec3 n = cross(dFdx(in_camera), dFdy(in_camera));
    n *= dot(n, in_camera) > 0.0 ? -1.0 : 1.0;
    float size = length(n);
    depth = in_camera.z;
    normal = vec4(size > 0.0 ? n / size : vec3(0.0, 0.0, -1.0), 1.0);
}
