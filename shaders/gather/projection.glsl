// Where a photograph shows a surface point, the same for the renderer and the web page. The file that
// includes this one defines struct photo, border_px, last_mip and view_focal.

// Where a photograph shows a point of its own camera frame: pixel coordinates, and z. Returns false if
// the point is behind the photograph or outside it.
bool photo_shows(photo source, vec3 q, out vec2 pixel, out float z)
{
    z = q.z;
    pixel = vec2(-1.0);
    if (!(q.z > 0.0))
        return false;
    pixel = source.focal.xy * q.xy * (1.0 / q.z) + source.focal.zw;
    vec2 border = min(pixel, source.size.xy - pixel);
    // Rounding must not drop the outermost pixels when the view is the photograph's own.
    return min(border.x, border.y) > 0.499;
}

// Projects a point of the view's camera frame into a photograph: pixel coordinates, and z in the
// photograph's frame. Returns what photo_shows does.
bool photo_project(photo source, vec3 p, out vec2 pixel, out float z)
{
    vec4 ph = vec4(p, 1.0);
    vec3 q = vec3(dot(source.from_view[0], ph), dot(source.from_view[1], ph),
                  dot(source.from_view[2], ph));
    return photo_shows(source, q, pixel, z);
}

// What is left of a photograph's weight at its border: enough to paint what no other photograph shows.
const float BORDER_MIN = 1e-3;

// Weight that falls from 1 to BORDER_MIN towards the photograph's border; 1 throughout if border_px
// is 0.
float photo_border(photo source, vec2 pixel)
{
    vec2 border = min(pixel, source.size.xy - pixel) - 0.5;
    float width = max(border_px, 0.5);
    return border_px > 0.0 ? clamp(min(border.x, border.y) / width, BORDER_MIN, 1.0) : 1.0;
}

// Mip level at which the photograph has the view's resolution.
float photo_mip(photo source, float z, float view_depth)
{
    float magnification = source.focal.x * view_depth / (z * view_focal.x);
    return clamp(log2(magnification), 0.0, last_mip);
}
