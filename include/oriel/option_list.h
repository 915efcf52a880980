// Every option of rendering, one row each (option_row.h); render.h makes fields of them, methods.c the table
// behind --set, oriel tune and docs/reference/options.md, gather.c the shaders' parameters.
#ifndef ORIEL_OPTION_LIST_H
#define ORIEL_OPTION_LIST_H

// The kinds are SLOT, a part of the method; WORD, a shader file of shaders/gather/FIELD; CHOICE; and FLOAT.
//
// ORL_TRIES: values that oriel tune tries, ascending. What is there to trade quality for time has none.
#define ORL_TRIES(...) .tries = {__VA_ARGS__}, .try_count = sizeof (double[]){__VA_ARGS__} / sizeof(double)

// clang-format off
#define ORL_RENDER_OPTIONS(ROW) \
    ROW(proxy, "proxy", SLOT(orl_proxy_kind, proxies, &orl_proxy_splats), .readers = "", .help = \
        "What stands for the scene's surfaces: its points (`splats`), its triangle `mesh`, or the " \
        "visual hull of its silhouettes as a mesh (`hull`) or as `voxels`.") \
    ROW(paint, "paint", SLOT(orl_painter, painters, &orl_paint_gather), .readers = "", .help = \
        "Who paints the picture: `gather` asks the photographs pixel by pixel, `tiled` asks " \
        "the best few photographs of each tile of the screen, `points` takes the colours of the " \
        "splats, or of the mesh's vertices, and `billboards` draws one for each voxel.") \
    ROW(select, "select", SLOT(orl_selection, selections, &orl_select_all), \
        .readers = "paint=gather paint=tiled", .help = \
        "The photographs that a frame may use: all of them, the `nearest` by their direction " \
        "from the scene's centre, the 32 that can paint the view best (`preselect`), or the " \
        "nearest and some more for what they see too obliquely (`princ`).") \
    ROW(visibility, "visibility", WORD(visibility_at, "hard"), .readers = "paint=gather paint=tiled", .help = \
        "Which photographs see a surface point: all (`none`), those whose own depth map agrees, " \
        "with a `hard` or a `soft` limit, those that the surface faces (`facing`), that it faces and " \
        "whose depth map agrees (`shadow`), or that it faces with nothing before it (`opaque`).") \
    ROW(weight, "weight", WORD(weight_at, "airieau"), .readers = "paint=gather paint=tiled", .help = \
        "How much a photograph counts that sees a surface point.") \
    ROW(combine, "combine", SLOT(orl_combine, combinations, &orl_combine_mean), \
        .readers = "paint=gather paint=tiled", .help = \
        "How the samples of a pixel become one colour: their weighted mean, the mean of the " \
        "four of greatest weight (`top`), the one of greatest weight (`best`), the mean of those that pass " \
        "a test of their standard deviation (`sigma`), or a mean that is robust against outliers.") \
    ROW(fill, "fill", CHOICE(orl_fill, ORL_FILLS, ORL_FILL_COLOR, ""), .readers = "", .help = \
        "What pixels without a surface show: black, the colours of their neighbours, " \
        "photographs projected to a guessed depth, the same with the depth no farther than " \
        "the ground, or pictures of the empty place projected on the walls of the scene's " \
        "`room`, or of a shell around it.") \
    ROW(sampling, "sampling", CHOICE(orl_sampling, ORL_SAMPLINGS, ORL_SAMPLING_BICUBIC, ""), \
        .readers = "paint=gather paint=tiled", .help = \
        "The filter that photographs are sampled with. `bicubic` is sharper and takes five " \
        "fetches instead of one.") \
    ROW(alignment, "alignment", CHOICE(orl_alignment_use, ORL_ALIGNMENT_USES, ORL_ALIGNMENT_OFF, ""), \
        .readers = "paint=gather paint=tiled", .help = \
        "Photographs are brought to one exposure and white balance, and their vignetting is " \
        "undone. Radiance is always aligned.") \
    ROW(antialias, "antialias", CHOICE(orl_antialias, ORL_ANTIALIASES, ORL_ANTIALIAS_OFF, ""), \
        .readers = "sample=srgb", .help = \
        "Colours are averaged across depth discontinuities, as a camera does, and specks take the colour around them.") \
    ROW(median, "median", CHOICE(orl_median, ORL_MEDIANS, ORL_MEDIAN_OFF, ""), .readers = "paint=gather", .help = \
        "A median filter of the painted picture, over 3x3 pixels of it all, or over the 5x5 " \
        "neighbours of surfaces that no photograph painted (`holes`).") \
    ROW(nearest, "nearest", FLOAT(4, 1, 1024, "photographs"), .readers = "select=nearest select=princ", .help = \
        "How many photographs a frame uses.") \
    ROW(photos_per_pixel, "photos_per_pixel", FLOAT(4, 1, 4, "photographs"), .readers = "paint=tiled", .help = \
        "The most photographs that are blended into a pixel. One more is asked and left out.") \
    ROW(outliers, "outliers", FLOAT(0.3f, 0, 1, "square root of light"), .readers = "combine=robust", .help = \
        "A sample that differs from the consensus by this much counts half. With 0 there are " \
        "no outliers.") \
    ROW(sharpness, "sharpness", FLOAT(2, 0, 64, ""), \
        .readers = "weight=lumigraph", ORL_TRIES(1, 2, 3, 4, 6, 10), .help = \
        "How strongly the better photograph is preferred. With 0 all weigh the same.") \
    ROW(depth_tolerance, "depth_tolerance", FLOAT(0.01f, 1e-5, 0.5, "fraction of depth"), \
        .readers = "visibility=hard visibility=soft visibility=shadow visibility=opaque paint=tiled", \
        ORL_TRIES(0.003, 0.005, 0.01, 0.02, 0.04), .help = \
        "How far two depths may differ and still count as the same surface.") \
    ROW(front_layer, "front_layer", FLOAT(0, 0, 0.1, "fraction of depth"), \
        .readers = "proxy=splats", ORL_TRIES(0, 0.005, 0.01, 0.02), .help = \
        "Splats no farther than this behind the nearest one are averaged with it. A splat that is farther from " \
        "all surfaces around is covered by them, and small groups of pixels are dropped as outliers. With 0 the " \
        "nearest splat alone counts.") \
    ROW(splat_scale, "splat_scale", FLOAT(1, 0.01, 16, ""), \
        .readers = "proxy=splats", ORL_TRIES(0.7, 1, 1.4), .help = \
        "Multiplies the radii of the splats. Larger splats close more holes and fatten edges.") \
    ROW(reconstructions, "reconstructions", FLOAT(1, 1, 9, "pictures"), .readers = "proxy=splats", .help = \
        "A frame is the mean of so many pictures, which differ in the size of the splats and by " \
        "parts of a pixel: what depends on these alone is chance. Time grows with their number. " \
        "Radiance takes one.") \
    ROW(guess_blur, "guess_blur", FLOAT(0.06f, 0, 1, "share of parallax"), \
        .readers = "paint=tiled", ORL_TRIES(0, 0.03, 0.06, 0.12, 0.25), .help = \
        "How far colours may lie from their place where depth is guessed and photographs " \
        "differ. They are blurred as far. With 0 they are not.") \
    ROW(guess_depths, "guess_depths", FLOAT(0, 0, 32, "depths"), .readers = "paint=tiled", ORL_TRIES(0, 16), .help = \
        "How many depths are tried where only a guessed depth is known, from the guess to " \
        "infinity. The guess moves to where photographs do not see past it. With 0 it stays.") \
    ROW(soft, "soft", FLOAT(0, 0, 1, "share"), .readers = "paint=tiled", .help = \
        "How far the scene's soft splats (`oriel refine`) correct structure that photographs have in the " \
        "wrong place. They mend what stereo cannot see, and `oriel refine` finds a good share.") \
    ROW(soft_mix, "soft_mix", FLOAT(0, 0, 1, "share"), .readers = "paint=tiled", .help = \
        "How much of the corrected picture comes from these splats themselves, as far as they cover it. " \
        "Without `soft` none does.") \
    ROW(hull_side, "hull_side", FLOAT(64, 8, 512, "voxels"), .readers = "proxy=voxels proxy=hull", .help = \
        "How many voxels the cube around the subject has each way. Time and memory of making " \
        "the hull grow with the third power.")
// clang-format on

// The choices and numbers as shaders see them, in this order.
#define ORL_INT_UNIFORM(field) int field;
#define ORL_FLOAT_UNIFORM(field) float field;
#define ORL_NO_UNIFORM(field)
#define ORL_UNIFORM_SLOT(...) ORL_NO_UNIFORM
#define ORL_UNIFORM_WORD(...) ORL_NO_UNIFORM
#define ORL_UNIFORM_CHOICE(...) ORL_INT_UNIFORM
#define ORL_UNIFORM_FLOAT(...) ORL_FLOAT_UNIFORM
#define ORL_UNIFORM(field, flag, kind, ...) ORL_UNIFORM_##kind(field)
struct render_options {
    ORL_RENDER_OPTIONS(ORL_UNIFORM)
};

#endif
