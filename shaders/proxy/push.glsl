// Which pixels keep their own surface, and what others get from the coarser level of the pyramid, for the renderer and for
// the page. The file that includes this one defines camera_ray and front_layer.
#include "proxy/surfel.glsl"

// The depth of a pixel's own splat; 0 if it lies farther than front_layer from all coarse surfels around. One of them
// was made from this pixel and keeps the nearest splats alone, so this splat is seen through a gap of a nearer surface,
// and its pixel is filled like an empty one. With front_layer 0 every splat counts.
float supported(float own_depth, surfel disc[4])
{
    bool agrees = front_layer == 0.0;
    for (int i = 0; i < 4; i++)
        agrees = agrees || abs(disc[i].depth - own_depth) <= front_layer * own_depth;
    return agrees ? own_depth : 0.0;
}

// The surfel that the coarse surfels (disc) give to the pixel with centre `target` and own near
// depth own_near (0: empty); an empty surfel if the pixel stays as it is. centre: of the coarse
// surfels, level 0 pixels; ray: to these centres, at unit depth.
surfel filled(vec2 target, float own_near, surfel disc[4], vec2 centre[4], vec2 ray[4], vec4 weight)
{
    vec2 target_ray = camera_ray(target);
    float front = 1e38, front_far = 0.0;
    for (int i = 0; i < 4; i++) {
        bool inside;
        float depth = surfel_depth_at(disc[i], ray[i], target_ray, inside);
        // A surfel smaller than a pixel still closes empty pixels around its centre, as the
        // low-pass filter of EWA does: otherwise slanted surfaces are full of pinholes. It occludes
        // nothing there.
        vec2 off = centre[i] - target;
        bool closes = own_near <= 0.0 &&
                      dot(off, off) <= SURFEL_MIN_RADIUS_PX * SURFEL_MIN_RADIUS_PX;
        bool hit = disc[i].radius > 0.0 && depth > 0.0 && (inside || closes);
        weight[i] = hit ? weight[i] : 0.0;
        bool nearer = hit && disc[i].near < front;
        front = nearer ? disc[i].near : front;
        front_far = nearer ? disc[i].far : front_far;
    }
    surfel sum = surfel(front, front_far, 0.0, 0.0, vec3(0.0), vec2(0.0));
    float total = 0.0;
    for (int i = 0; i < 4; i++) {
        float w = disc[i].near <= front_far ? weight[i] : 0.0;
        sum.far = max(sum.far, w > 0.0 ? disc[i].far : 0.0);
        sum.depth += w * disc[i].depth;
        sum.radius += w * disc[i].radius;
        sum.normal += w * disc[i].normal;
        sum.displacement += w * (centre[i] - target);
        total += w;
    }
    // A pixel with a surface of its own keeps it unless a nearer surfel occludes it.
    if (total == 0.0 || (own_near > 0.0 && own_near <= front_far))
        return NO_SURFEL;
    return surfel_mean(sum, total);
}
