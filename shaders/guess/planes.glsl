// The depths that are tried where the surface has none. The view is divided into cells, and each
// open cell, which has estimated background depth alone, takes one of gather_block's `planes`.
// Plane k is at the inverse depth k * plane_step; plane 0 is at infinity.
const int PLANES_MAX = 32; // of the option guess_depths

const float CLOSED = -1.0; // cost of the planes of a cell that is not open

ivec2 cells_across_down()
{
    return (view_size + GUESS_CELL - 1) / GUESS_CELL;
}

// Index of the first of a cell's costs.
int first_cost(ivec2 cell)
{
    return (cell.y * cells_across_down().x + cell.x) * planes;
}

// Plane 0 as a finite depth.
float plane_inverse(float k)
{
    return max(k, 0.02) * plane_step;
}
