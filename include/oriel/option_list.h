// Every option of rendering, one row each; render.h makes fields of them, options.c the table
// behind --set, oriel tune and docs/reference/options.md, gather.c the shaders' parameters.
#ifndef ORIEL_OPTION_LIST_H
#define ORIEL_OPTION_LIST_H

// SLOT(field, type, default, readers, help): a part of the method that is chosen by name; a pointer.
// FILE(field, default, readers, help): one that is a shader file of shaders/gather/FIELD.
// CHOICE(field, type, names, default, readers, help): one of a few names, of an enum.
// NUMBER(field, default, least, most, unit, readers, tries, help): a float in [least, most].
//
// readers: which choices make anything read it, as "key=name" separated by spaces, any of which
// is enough; "": every frame does. tries: values that oriel tune tries, ascending;
// ORL_NO_TRIES: none, which includes all that is there to trade quality for time.
#define ORL_TRIES(...) {__VA_ARGS__}
#define ORL_NO_TRIES {0}

// clang-format off
#define ORL_RENDER_OPTIONS(SLOT, FILE, CHOICE, NUMBER) \
    SLOT(proxy, orl_proxy_kind, &orl_proxy_splats, "", \
        "What stands for the scene's surfaces: its points (`splats`), its triangle `mesh`, or the " \
        "visual hull of its silhouettes as a mesh (`hull`) or as `voxels`.") \
    SLOT(paint, orl_painter, &orl_paint_gather, "", \
        "Who paints the picture: `gather` asks the photographs pixel by pixel, `tiled` asks " \
        "the best few photographs of each tile of the screen, `points` takes the colours of the " \
        "splats, or of the mesh's vertices, and `billboards` draws one for each voxel.") \
    SLOT(select, orl_selection, &orl_select_all, "paint=gather paint=tiled", \
        "The photographs that a frame may use: all of them, the `nearest` by their direction " \
        "from the scene's centre, the 32 that can paint the view best (`preselect`), or the " \
        "nearest and some more for what they see too obliquely (`princ`).") \
    FILE(visibility, "hard", "paint=gather paint=tiled", \
        "Which photographs see a surface point: all (`none`), those whose own depth map agrees, " \
        "with a `hard` or a `soft` limit, those that the surface faces (`facing`), that it faces and " \
        "whose depth map agrees (`shadow`), or that it faces with nothing before it (`opaque`).") \
    FILE(weight, "airieau", "paint=gather paint=tiled", \
        "How much a photograph counts that sees a surface point.") \
    SLOT(combine, orl_combine, &orl_combine_mean, "paint=gather paint=tiled", \
        "How the samples of a pixel become one colour: their weighted mean, the mean of the " \
        "four of greatest weight (`top`), the one of greatest weight (`best`), the mean of those that pass " \
        "a test of their standard deviation (`sigma`), or a mean that is robust against outliers.") \
    CHOICE(fill, orl_fill, "none color depth ground room", ORL_FILL_COLOR, "", \
        "What pixels without a surface show: black, the colours of their neighbours, " \
        "photographs projected to a guessed depth, the same with the depth no farther than " \
        "the ground, or pictures of the empty place projected on the walls of the scene's " \
        "`room`, or of a shell around it.") \
    CHOICE(sampling, orl_sampling, "bilinear bicubic", ORL_SAMPLING_BICUBIC, \
        "paint=gather paint=tiled", \
        "The filter that photographs are sampled with. `bicubic` is sharper and takes five " \
        "fetches instead of one.") \
    CHOICE(alignment, orl_alignment_use, "off on", ORL_ALIGNMENT_OFF, "paint=gather paint=tiled", \
        "Photographs are brought to one exposure and white balance, and their vignetting is " \
        "undone. Radiance is always aligned.") \
    CHOICE(antialias, orl_antialias, "off on", ORL_ANTIALIAS_OFF, "sample=srgb", \
        "Colours are averaged across depth discontinuities, as a camera does, and specks take the colour around them.") \
    CHOICE(median, orl_median, "off holes all", ORL_MEDIAN_OFF, "paint=gather", \
        "A median filter of the painted picture, over 3x3 pixels of it all, or over the 5x5 " \
        "neighbours of surfaces that no photograph painted (`holes`).") \
    NUMBER(nearest, 4, 1, 1024, "photographs", "select=nearest select=princ", ORL_NO_TRIES, \
        "How many photographs a frame uses.") \
    NUMBER(photos_per_pixel, 4, 1, 4, "photographs", "paint=tiled", ORL_NO_TRIES, \
        "The most photographs that are blended into a pixel. One more is asked and left out.") \
    NUMBER(outliers, 0.3f, 0, 1, "square root of light", "combine=robust", ORL_NO_TRIES, \
        "A sample that differs from the consensus by this much counts half. With 0 there are " \
        "no outliers.") \
    NUMBER(sharpness, 2, 0, 64, "", "weight=lumigraph", ORL_TRIES(1, 2, 3, 4, 6, 10), \
        "How strongly the better photograph is preferred. With 0 all weigh the same.") \
    NUMBER(depth_tolerance, 0.01f, 1e-5, 0.5, "fraction of depth", "visibility=hard " \
        "visibility=soft visibility=shadow visibility=opaque paint=tiled", \
        ORL_TRIES(0.003, 0.005, 0.01, 0.02, 0.04), \
        "How far two depths may differ and still count as the same surface.") \
    NUMBER(front_layer, 0, 0, 0.1, "fraction of depth", "proxy=splats", \
        ORL_TRIES(0, 0.005, 0.01, 0.02), \
        "Splats no farther than this behind the nearest one are averaged with it. A splat that is farther from " \
        "all surfaces around is covered by them. With 0 the nearest splat alone counts.") \
    NUMBER(splat_scale, 1, 0.01, 16, "", "proxy=splats", ORL_TRIES(0.7, 1, 1.4), \
        "Multiplies the radii of the splats. Larger splats close more holes and fatten edges.") \
    NUMBER(reconstructions, 1, 1, 9, "pictures", "proxy=splats", ORL_NO_TRIES, \
        "A frame is the mean of so many pictures, which differ in the size of the splats and by " \
        "parts of a pixel: what depends on these alone is chance. Time grows with their number. " \
        "Radiance takes one.") \
    NUMBER(guess_blur, 0.06f, 0, 1, "share of parallax", "paint=tiled", \
        ORL_TRIES(0, 0.03, 0.06, 0.12, 0.25), \
        "How far colours may lie from their place where depth is guessed and photographs " \
        "differ. They are blurred as far. With 0 they are not.") \
    NUMBER(guess_depths, 0, 0, 32, "depths", "paint=tiled", ORL_TRIES(0, 16), \
        "How many depths are tried where only a guessed depth is known, from the guess to " \
        "infinity. The guess moves to where photographs do not see past it. With 0 it stays.") \
    NUMBER(soft, 0, 0, 1, "share", "paint=tiled", ORL_NO_TRIES, \
        "How far the scene's soft splats (`oriel refine`) correct structure that photographs have in the " \
        "wrong place. They mend what stereo cannot see, and `oriel refine` finds a good share.") \
    NUMBER(soft_mix, 0, 0, 1, "share", "paint=tiled", ORL_NO_TRIES, \
        "How much of the corrected picture comes from these splats themselves, as far as they cover it. " \
        "Without `soft` none does.") \
    NUMBER(hull_side, 64, 8, 512, "voxels", "proxy=voxels proxy=hull", ORL_NO_TRIES, \
        "How many voxels the cube around the subject has each way. Time and memory of making " \
        "the hull grow with the third power.")
// clang-format on

// The choices and numbers as shaders see them, in this order.
#define ORL_NO_MEMBER(...)
#define ORL_INT_MEMBER(field, type, names, preset, readers, help) int field;
#define ORL_FLOAT_MEMBER(field, preset, least, most, unit, readers, tries, help) float field;
struct render_options {
    ORL_RENDER_OPTIONS(ORL_NO_MEMBER, ORL_NO_MEMBER, ORL_INT_MEMBER, ORL_FLOAT_MEMBER)
};
#undef ORL_NO_MEMBER
#undef ORL_INT_MEMBER
#undef ORL_FLOAT_MEMBER

#endif
