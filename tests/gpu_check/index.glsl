// Ahead of every compute program while ORIEL_GPU_CHECK is set (rewrite.c): an index
// outside of its array is recorded and brought to the nearest end, so that the program goes on.
layout(std430, binding = 7) buffer orl_check_record {
    uint orl_check_count; // wrong indexes since the record was cleared
    uint orl_check_site;  // the number of the first of them
    int orl_check_first;  // its value
    int orl_check_size;   // elements of the array
};

int orl_check_index(int index, int size, uint site)
{
    if (index < 0 || index >= size) {
        if (atomicAdd(orl_check_count, 1u) == 0u) {
            orl_check_site = site;
            orl_check_first = index;
            orl_check_size = size;
        }
    }
    return clamp(index, 0, max(size - 1, 0));
}

int orl_check_index(uint index, int size, uint site)
{
    return orl_check_index(index > 0x7fffffffu ? -1 : int(index), size, site);
}

// Texels that a fetch reads: those outside are undefined.
int orl_check_fetch(int at, int size, uint site)
{
    return orl_check_index(at, size, site);
}

ivec2 orl_check_fetch(ivec2 at, ivec2 size, uint site)
{
    return ivec2(orl_check_index(at.x, size.x, site), orl_check_index(at.y, size.y, site));
}

ivec3 orl_check_fetch(ivec3 at, ivec3 size, uint site)
{
    return ivec3(orl_check_fetch(at.xy, size.xy, site), orl_check_index(at.z, size.z, site));
}

// Texels of images. Outside of a buffer's there is a fault. Outside of a picture's the language
// defines what happens (reads give 0, writes nothing), and shaders use that at borders.
int orl_check_image(int at, int size, uint site)
{
    return orl_check_index(at, size, site);
}

ivec2 orl_check_image(ivec2 at, ivec2 size, uint site)
{
    return at;
}
