// A photograph sees a surface that faces it, not nearly edge-on, with nothing before it: opaque
// projective texture mapping, Li 2003, 5.2. Its depth map is that of a shadow map whose outlines
// may be fattened, so that only what is clearly nearer hides a point; where it is empty, nothing
// does.
#include "gather/hidden.glsl"

// Surfaces seen at less than about 6 degrees are "tangent" and not coloured; the paper names no
// angle.
const float TANGENT = 0.1;

bool photo_lit(vec4 seen, float z)
{
    float nearest = z - opt.depth_tolerance * z;
    return any(bvec4(seen.x <= 0.0 || seen.x > nearest, seen.y <= 0.0 || seen.y > nearest,
                     seen.z <= 0.0 || seen.z > nearest, seen.w <= 0.0 || seen.w > nearest));
}

float visible_surface(photo source, Point at, vec4 seen, float z)
{
    vec3 sight = at.p - source.eye.xyz;
    bool faces = dot(at.normal, sight) < -TANGENT * length(sight);
    return faces && photo_lit(seen, z) ? 1.0 : 0.0;
}

float visible_guess(photo source, Point at, vec4 seen, float z)
{
    return photo_unhidden(seen, z) ? 1.0 : 0.0; // no part of the subject may paint what lies behind it
}
