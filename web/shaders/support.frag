// Drops stray points and closes small holes, as shaders/proxy/support.comp does.
uniform sampler2D depth_in, normal_in;
uniform float min_support;
layout(location = 0) out float depth_out;
layout(location = 1) out vec4 normal_out;

const float MOST = 13.0;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depth_in, 0) - 1;
    float depth = texelFetch(depth_in, at, 0).x;
    float least = depth > 0.0 ? 0.97 * depth : 1e-30, most = depth > 0.0 ? 1.03 * depth : 1e30;
    float agree = 0.0, known = 0.0, sum = 0.0, near = 1e30, far = 0.0;
    for (int y = -2; y <= 2; y++)
        for (int x = -2; x <= 2; x++) {
            float z = texelFetch(depth_in, clamp(at + ivec2(x, y), ivec2(0), last), 0).x;
            known += z > 0.0 ? 1.0 : 0.0;
            sum += z;
            near = min(near, z > 0.0 ? z : near);
            far = max(far, z);
            agree += z >= least && z <= most ? 1.0 : 0.0;
        }
    bool keep = depth > 0.0 && agree >= min_support;
    bool close = depth == 0.0 && agree >= MOST && far < 1.06 * near;
    depth_out = keep ? depth : close ? sum / known : 0.0;
    normal_out = keep ? texelFetch(normal_in, at, 0) : vec4(0.0);
}
