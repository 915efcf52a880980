// The splats in their buffer.
#define BLOCK_SOFT
#include "shared/soft_blocks.h"

// ORL_SOFT_VEC4S of each. Buffers are read as images: storage reads take a software renderer several times as long.
layout(rgba32f, binding = 2) uniform imageBuffer splats;

// The splat or tile of this invocation.
int own_item()
{
    return int(gl_GlobalInvocationID.y) * ORL_SOFT_ROW + int(gl_GlobalInvocationID.x);
}

mat3 view_rotation()
{
    return transpose(mat3(rotation[0].xyz, rotation[1].xyz, rotation[2].xyz));
}

#include "soft/seen.glsl"

vec4 splat_row(int i, int row)
{
    return imageLoad(splats, ORL_SOFT_VEC4S * i + row);
}

splat splat_at(int i)
{
    vec4 a = splat_row(i, 0), b = splat_row(i, 1), q = splat_row(i, 2);
    float size = max(length(q), 1e-12);
    return splat(a.xyz, exp(b.xyz), 1.0 / (1.0 + exp(-a.w)), q / size, size);
}
