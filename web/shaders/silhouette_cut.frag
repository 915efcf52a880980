// Gives pixels before an edge to what is behind it where they and their neighbours vote so.
uniform sampler2D votes; // silhouette_vote.frag
uniform sampler2D view_depth, normal_in;
layout(location = 0) out float depth;
layout(location = 1) out vec4 normal;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), area = textureSize(votes, 0);
    depth = texelFetch(view_depth, at, 0).x;
    normal = texelFetch(normal_in, at, 0);
    float behind = texelFetch(votes, at, 0).y, sum = 0.0;
    if (behind == 0.0)
        return;
    for (int i = 0; i < 9; i++) {
        ivec2 from = at + ivec2(i % 3, i / 3) - 1;
        if (from.x >= 0 && from.y >= 0 && from.x < area.x && from.y < area.y)
            sum += texelFetch(votes, from, 0).x;
    }
    if (sum > 0.0) {
        depth = behind;
        normal = vec4(0.0);
    }
}
