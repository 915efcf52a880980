// The depths that are tried where the surface has none, for the renderer and for the page. The view is divided
// into cells of CELL pixels, and each open cell, which has estimated background depth alone, takes one of PLANES:
// plane 0 is its estimate, the last one is at infinity, and inverse depth falls by equal steps. Their number is
// part of the program, since software renderers keep arrays of constant indices in registers.

const float CLOSED = -1.0; // cost of the planes of a cell that is not open

// Inverse depth of a plane as a share of the estimate's.
float plane_share(int k)
{
    return 1.0 - float(k) / float(PLANES - 1);
}
