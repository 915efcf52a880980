// Depth of the walls of a room, or with SHELL of a sphere, around the scene; included where ROOM is
// defined.

// 0: the ray meets none from inside.
float room_depth(ivec2 at)
{
    vec4 ray = vec4((vec2(at) + 0.5 - view_focal.zw) / view_focal.xy, 1.0, 0.0);
    vec3 from = vec3(local_from_view[0].w, local_from_view[1].w, local_from_view[2].w);
    vec3 along = vec3(dot(local_from_view[0], ray), dot(local_from_view[1], ray),
                      dot(local_from_view[2], ray));
#ifdef SHELL
    float a = dot(along, along), b = dot(along, from), c = dot(from, from) - 1.0;
    float root = b * b - a * c;
    float out_of = root > 0.0 ? (sqrt(root) - b) / a : 0.0;
    return max(out_of, 0.0);
#else
    vec3 ahead = mix(vec3(-1.0), vec3(1.0), greaterThan(along, vec3(0.0)));
    along = mix(along, 1e-12 * ahead, lessThan(abs(along), vec3(1e-12)));
    vec3 leave = (ahead - from) / along, enter = (-ahead - from) / along;
    float last = min(min(leave.x, leave.y), leave.z);
    float first = max(max(enter.x, enter.y), enter.z);
    return last > max(first, 0.0) ? last : 0.0;
#endif
}
