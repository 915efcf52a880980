// Where the renderer keeps the costs of a cell's planes.
#include "guess/planes.glsl"

ivec2 cells_across_down()
{
    return (view_size + CELL - 1) / CELL;
}

// Index of the first of a cell's costs.
int first_cost(ivec2 cell)
{
    return (cell.y * cells_across_down().x + cell.x) * PLANES;
}
