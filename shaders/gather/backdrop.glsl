// A backdrop that rests in the pictures, as behind a turntable. Included after
// gather/hidden.glsl; painters use it where RESTS is defined.

// True if a photograph shows the backdrop at the place of its camera frame where the view has p.
bool photo_backdrop(photo source, vec3 p, out vec2 pixel)
{
    float z;
    bool inside = photo_shows(source, p, pixel, z);
    // Depth is 0 outside the object, and below 0 in holes of its surfaces.
    return inside && all(equal(photo_depths(source, pixel), vec4(0.0)));
}
