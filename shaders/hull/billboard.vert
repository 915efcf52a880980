// A voxel as a square parallel to the image plane. PAINTED: with the photographs that paint it.
#include "shared/interop.h"

#ifdef PAINTED
#define BLOCK_GATHER
#include "shared/render_blocks.h"
layout(location = 1) in uint photos;  // the first in the lower half, the second in the upper
layout(location = 2) in float second; // weight of the second, relative to the first
layout(location = 1) flat out uint painted_by;
layout(location = 2) flat out float second_weight;
#else
#define BLOCK_BILLBOARD
#include "shared/hull_blocks.h"
#endif

layout(location = 0) in vec3 centre; // PAINTED: the view's camera frame; else world
layout(location = 0) out vec3 in_camera;

void main()
{
    int corner = gl_VertexID < 3 ? gl_VertexID : gl_VertexID - 2; // two triangles
    vec2 turn = 2.0 * vec2(corner & 1, corner >> 1) - 1.0;
#ifdef PAINTED
    vec3 p = centre;
    painted_by = photos;
    second_weight = second;
#else
    vec3 d = centre - eye.xyz;
    vec3 p = vec3(dot(rotation[0].xyz, d), dot(rotation[1].xyz, d), dot(rotation[2].xyz, d));
#endif
    p.xy += billboard_half * turn;
    in_camera = p;
    // As in proxy/mesh.vert; what is nearer than half a billboard is cut off.
    vec2 pixel = view_focal.xy * p.xy + view_focal.zw * p.z;
    gl_Position = vec4(2.0 * pixel / vec2(view_size) - p.z, p.z - 2.0 * billboard_half, p.z);
}
