// The photographs that can paint a tile of the screen best, for the renderer and for the page. The file that
// includes this one defines CANDIDATES, how many they are.

// Takes a sample point of the tile into account that a photograph shows. share: of it that nothing hides there.
void candidate_sample(float share, float penalty, inout float least, inout float seen)
{
    float hidden = share > 0.9 ? 1.0 : 8.0;
    least = min(least, penalty * hidden);
    seen += 1.0 / hidden;
}

// The least penalty at any sample point, raised a little for photographs that see few points.
float candidate_penalty(float least, float seen)
{
    return seen == 0.0 ? NOT_SEEN : least * (1.0 + 1.0 / max(seen, 0.1));
}

// Insertion sort, best first.
void candidate_insert(float penalty, int photo, inout float best[CANDIDATES], inout int index[CANDIDATES])
{
    for (int c = 0; c < CANDIDATES; c++) {
        if (penalty < best[c]) {
            float b = best[c];
            int n = index[c];
            best[c] = penalty;
            index[c] = photo;
            penalty = b;
            photo = n;
        }
    }
}
