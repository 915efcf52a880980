// Finest level of the pyramid that guesses depth, at half the picture's size: inverse depth,
// weighted so steeply towards far surfaces that a hole takes the farther one of its rim.
uniform sampler2D known;
uniform float typical;
layout(location = 0) out vec4 seeded;

void main()
{
    ivec2 at = 2 * ivec2(gl_FragCoord.xy), area = textureSize(known, 0);
    seeded = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 from = at + ivec2(i & 1, i >> 1);
        float z = from.x < area.x && from.y < area.y ? texelFetch(known, from, 0).x : 0.0;
        float weight = clamp(pow(z / typical, 14.0), 1e-15, 1e15);
        seeded += z > 0.0 ? vec4(1.0 / z, 0.0, 0.0, 1.0) * weight : vec4(0.0);
    }
}
