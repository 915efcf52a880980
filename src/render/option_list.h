// Every option of rendering, one row each; render.h makes fields of them, options.c the table
// behind --set, oriel tune and docs/reference/options.md, block.c the shaders' parameters.
#ifndef ORL_RENDER_OPTION_LIST_H
#define ORL_RENDER_OPTION_LIST_H

// SLOT(field, default, readers, help): a part of the method that is chosen by name.
// CHOICE(field, type, names, default, readers, help): one of a few names, of an enum.
// NUMBER(field, default, least, most, unit, readers, tries, help): a float in [least, most].
//
// readers: which choices make anything read it, as "key=name" separated by spaces, any of which
// is enough; "": every frame does. tries: values that oriel tune tries, ascending;
// ORL_NO_TRIES: none, which includes all that is there to trade quality for time.
#define ORL_TRIES(...) {__VA_ARGS__}
#define ORL_NO_TRIES {0}

// clang-format off
#define ORL_RENDER_OPTIONS(SLOT, CHOICE, NUMBER) \
    SLOT(proxy, "splats", "", \
        "what stands for the scene's surfaces") \
    SLOT(paint, "gather", "", \
        "who paints: gather asks photographs pixel by pixel, tiled the best few of each tile of " \
        "the screen, points takes the splats' own colour") \
    SLOT(select, "all", "paint=gather paint=tiled", \
        "photographs that a frame uses: all, or those that can paint the view best") \
    SLOT(visibility, "hard", "paint=gather paint=tiled", \
        "which photographs see a surface point: all, or those whose depth map agrees, hard or " \
        "with a soft edge") \
    SLOT(weight, "airieau", "paint=gather paint=tiled", \
        "how much a photograph counts that sees a surface point") \
    SLOT(combine, "mean", "paint=gather paint=tiled", \
        "how the samples of a pixel become one colour") \
    CHOICE(fill, orl_fill, "none color depth ground", ORL_FILL_COLOR, "", \
        "pixels without surface: black, neighbours' colour, photographs at a guessed depth, or " \
        "that and no farther than the ground") \
    CHOICE(sampling, orl_sampling, "bilinear bicubic", ORL_SAMPLING_BICUBIC, \
        "paint=gather paint=tiled", \
        "of photographs; bicubic is sharper and takes five fetches instead of one") \
    CHOICE(alignment, orl_alignment_use, "off on", ORL_ALIGNMENT_OFF, "paint=gather paint=tiled", \
        "photographs are brought to one exposure and white balance, their vignetting undone; of " \
        "radiance always") \
    CHOICE(antialias, orl_antialias, "off on", ORL_ANTIALIAS_OFF, "sample=srgb", \
        "depth edges are averaged with their neighbours, as in photographs") \
    NUMBER(photos_per_pixel, 4, 1, 4, "photographs", "paint=tiled", ORL_NO_TRIES, \
        "blended into a pixel, at most") \
    NUMBER(candidates, 6, 1, 8, "photographs", "paint=tiled", ORL_NO_TRIES, \
        "of its tile that a pixel asks; fewer are faster, and miss more behind obstacles") \
    NUMBER(outliers, 0.3f, 0, 1, "square root of light", "combine=robust", ORL_NO_TRIES, \
        "a sample that differs by this much from the consensus counts half; 0: all count") \
    NUMBER(sharpness, 3, 0, 64, "", "weight=lumigraph", ORL_TRIES(1, 2, 3, 4, 6, 10), \
        "how fast the better photograph is preferred; 0: equal weights") \
    NUMBER(depth_tolerance, 0.01f, 1e-5, 0.5, "fraction of depth", "visibility=hard visibility=soft paint=tiled", \
        ORL_TRIES(0.003, 0.005, 0.01, 0.02, 0.04), \
        "how far depths may differ on the same surface") \
    NUMBER(min_support, 0, 0, 25, "pixels of 5x5", "proxy=splats", ORL_TRIES(0, 4, 8, 12, 16), \
        "with a surface at the same depth that a pixel needs, else it is a stray point; above 0, " \
        "holes with 13 around them are closed") \
    NUMBER(front_layer, 0, 0, 0.1, "fraction of depth", "proxy=splats", \
        ORL_TRIES(0, 0.005, 0.01, 0.02), \
        "splats this close behind the nearest one are averaged with it; 0: the nearest alone") \
    NUMBER(splat_scale, 1, 0.01, 16, "", "proxy=splats", ORL_TRIES(0.7, 1, 1.4), \
        "multiplies splat radii; larger closes more holes and fattens edges") \
    NUMBER(silhouette, 0, 0, 4, "pixels", "paint=tiled", ORL_TRIES(0, 1, 2, 3), \
        "by which depth may reach past silhouettes; where photographs agree far better on what " \
        "is behind, it is taken back; 0: nowhere") \
    NUMBER(guess_sharpness, 1.5f, 0, 64, "", "weight=lumigraph", ORL_TRIES(0.5, 1, 2, 4, 8), \
        "the same where only a guessed depth is known") \
    NUMBER(guess_blur, 0.06f, 0, 1, "share of parallax", "paint=tiled", \
        ORL_TRIES(0, 0.03, 0.06, 0.12, 0.25), \
        "that colour may lie from its place where depth is guessed and photographs differ; " \
        "blurred as far; 0: not") \
    NUMBER(unknown_trust, 0.5f, 0, 1, "share", "visibility=soft sample=radiance", \
        ORL_TRIES(0, 0.02, 0.05, 0.15, 0.5), \
        "of trust in a photograph that has no depth where the surface would be") \
    NUMBER(distance_floor, 0.03f, 1e-4, 1, "fraction of viewing distance", "weight=airieau", \
        ORL_TRIES(0.01, 0.03, 0.1, 0.3), \
        "keeps Airieau's distance difference from zero") \
    NUMBER(border_px, 8, 0, 1024, "pixels of the photograph", "paint=gather paint=tiled", \
        ORL_TRIES(4, 8, 16, 48), \
        "photographs fade out over this width at their border") \
    NUMBER(points_per_pixel, 4, 0, 64, "points", "proxy=splats", ORL_NO_TRIES, \
        "above which splats are thinned and enlarged; 0: all are drawn") \
    NUMBER(ghosts, 1, 0, 16, "stops", "sample=radiance", ORL_NO_TRIES, \
        "samples this far from the others count half, beyond noise and edges; 0: all count")
// clang-format on

// The choices and numbers as shaders see them, in this order.
#define ORL_NO_MEMBER(field, preset, readers, help)
#define ORL_INT_MEMBER(field, type, names, preset, readers, help) int field;
#define ORL_FLOAT_MEMBER(field, preset, least, most, unit, readers, tries, help) float field;
struct render_options {
    ORL_RENDER_OPTIONS(ORL_NO_MEMBER, ORL_INT_MEMBER, ORL_FLOAT_MEMBER)
};
#undef ORL_NO_MEMBER
#undef ORL_INT_MEMBER
#undef ORL_FLOAT_MEMBER

#endif
