// Texels of a depth map that is kept at a smaller size than it was drawn at. Each is one that was
// drawn, since a mean of depths on both sides of an outline is on neither surface.

ivec2 drawn_texel(ivec2 kept, ivec2 drawn_size, ivec2 kept_size)
{
    return min(ivec2((vec2(kept) + 0.5) * vec2(drawn_size) / vec2(kept_size)), drawn_size - 1);
}
