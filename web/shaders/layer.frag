// Sums, by blending, how far the points of the front layer lie behind the nearest.
flat in float behind;
layout(location = 0) out vec2 sum;

void main()
{
    sum = vec2(behind, 1.0);
}
