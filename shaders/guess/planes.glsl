// The depths that are tried where the surface has none. The view is divided into cells of CELL pixels, and each
// open cell, which has estimated background depth alone, takes one of gather_block's `planes`: plane
// 0 is its estimate, the last one is at infinity, and inverse depth falls by equal steps.
const int PLANES_MAX = 32; // of the option guess_depths

const float CLOSED = -1.0; // cost of the planes of a cell that is not open

ivec2 cells_across_down()
{
    return (view_size + CELL - 1) / CELL;
}

// Index of the first of a cell's costs.
int first_cost(ivec2 cell)
{
    return (cell.y * cells_across_down().x + cell.x) * planes;
}

// Inverse depth of a plane as a share of the estimate's.
float plane_share(float k)
{
    return 1.0 - k / float(planes - 1);
}
