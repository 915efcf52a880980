// The colours and shapes of videos, by clips that ffmpeg makes of two patches.
#include <stdio.h>
#include <string.h>

#include "io/picture.h"
#include "io/video.h"
#include "test.h"

enum { W = 64, H = 48, TOLERANCE = 3 };
static const uint8_t red[3] = {200, 30, 30}, green[3] = {40, 180, 40};

static char *dir;

static int set_up(void **state)
{
    (void)state;
    dir = test_dir_make();
    struct orl_image image;
    char *path = test_path(dir, "00000.png");
    if (orl_image_init(NULL, &image, W, H, 3, ORL_PIXEL_U8) != ORL_OK)
        return -1;
    for (int i = 0; i < W * H; i++)
        memcpy(image.u8 + 3 * i, i % W < W / 2 ? red : green, 3);
    bool ok = orl_png_write(NULL, path, &image) == ORL_OK;
    orl_image_finish(&image);
    free(path);
    return ok ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    test_dir_remove(dir);
    return 0;
}

// Makes dir/NAME of the patches. False where this ffmpeg lacks what it takes. FFmpeg 7 and later take
// primaries and curve from what the filters say of frames, as setparams does, not from options.
static bool make(const char *name, const char *filters, const char *tags)
{
    char command[2048];
    snprintf(command, sizeof command, "cd %s && ffmpeg -nostdin -loglevel quiet -y -loop 1 -i 00000.png "
             "-frames:v 2 -vf '%s' -c:v libx264 -qp 0 %s %s", dir, filters, tags, name);
    return system(command) == 0;
}

static void expect_pixel(const struct orl_image *image, int x, const uint8_t want[3])
{
    const uint8_t *got =
        image->u8 + 3 * ((size_t)(image->height / 2) * (size_t)image->width + (size_t)x);
    for (int c = 0; c < 3; c++)
        assert_between(got[c] + 255 - want[c], 255 - TOLERANCE, 255 + TOLERANCE);
}

// The first frame of dir/NAME has the two colours.
static void expect_colours(const char *name, const uint8_t left[3], const uint8_t right[3])
{
    const struct orl_frame_range range = {0, 1, 1};
    char *clip = test_path(dir, name), *frame = test_path(dir, "frames/00000.ppm");
    char *frames = test_path(dir, "frames");
    struct orl_image image;
    assert_int_equal(orl_dir_make(NULL, frames), ORL_OK);
    assert_int_equal(orl_video_decode(NULL, NULL, clip, &range, frames), ORL_OK);
    assert_int_equal(orl_picture_read(NULL, frame, 3, &image), ORL_OK);
    expect_pixel(&image, image.width / 4, left);
    expect_pixel(&image, image.width * 3 / 4, right);
    orl_image_finish(&image);
    free(clip);
    free(frame);
    free(frames);
}

static void expect_patches(const char *name)
{
    expect_colours(name, red, green);
}

static void follows_matrix_and_range(void **state)
{
    (void)state;
    static const struct {
        const char *matrix, *range, *space;
    } kinds[] = {{"bt601", "tv", "smpte170m"}, {"bt601", "pc", "smpte170m"},
                 {"bt709", "tv", "bt709"}, {"bt709", "pc", "bt709"}, {"bt2020", "tv", "bt2020nc"}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        char filters[128], tags[128];
        snprintf(filters, sizeof filters, "scale=out_color_matrix=%s:out_range=%s,format=yuv444p",
                 kinds[i].matrix, kinds[i].range);
        snprintf(tags, sizeof tags, "-colorspace %s -color_range %s", kinds[i].space,
                 kinds[i].range);
        if (!make("clip.mp4", filters, tags))
            skip();
        expect_patches("clip.mp4");
    }
}

// As players have it.
static void guesses_untagged_matrices(void **state)
{
    (void)state;
    if (!make("clip.mkv", "scale=960:720:out_color_matrix=bt709:out_range=tv:flags=neighbor,"
              "format=yuv444p", ""))
        skip();
    expect_patches("clip.mkv");
    assert_true(make("clip.mkv", "scale=out_color_matrix=bt601:out_range=tv,format=yuv444p", ""));
    expect_patches("clip.mkv");
}

static void brings_hdr_and_wide_colours_to_srgb(void **state)
{
    (void)state;
    static const char from[] = "format=gbrp16le,zscale=min=gbr:rin=full:pin=bt709:tin=iec61966-2-1:"
                               "t=linear:npl=203:p=bt709,format=gbrpf32le,zscale=p=%s:t=%s:npl=203:agamma=0,"
                               "format=gbrp16le,scale=out_color_matrix=%s:out_range=tv,"
                               "format=yuv444p10le";
    static const struct {
        const char *primaries, *transfer, *matrix, *space;
    } kinds[] = {{"bt2020", "smpte2084", "bt2020", "bt2020nc"},
                 {"bt2020", "arib-std-b67", "bt2020", "bt2020nc"},
                 {"bt2020", "iec61966-2-1", "bt2020", "bt2020nc"},
                 {"smpte432", "iec61966-2-1", "bt709", "bt709"}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        char filters[512], tags[256];
        snprintf(filters, sizeof filters, from, kinds[i].primaries, kinds[i].transfer,
                 kinds[i].matrix);
        snprintf(tags, sizeof tags, "-colorspace %s -color_primaries %s -color_trc %s "
                 "-color_range tv", kinds[i].space, kinds[i].primaries, kinds[i].transfer);
        if (!make("clip.mp4", filters, tags))
            skip(); // without zscale
        expect_patches("clip.mp4");
    }
}

// HLG by hand: the inverse of BT.2100's OETF, its system gamma of 1.2 by luminance on a display of
// 1000 cd/m2, BT.2020 to BT.709, and 203 cd/m2 as white.
static void shows_hlg_as_its_standard(void **state)
{
    (void)state;
    const uint8_t want[3] = {217, 97, 94};
    if (!make("clip.mp4", "format=gbrp16le,lutrgb=r=42598:g=26214:b=22937,"
              "scale=out_color_matrix=bt2020:out_range=tv,format=yuv444p10le,"
              "setparams=color_primaries=bt2020:color_trc=arib-std-b67:colorspace=bt2020nc:range=tv", ""))
        skip();
    expect_colours("clip.mp4", want, want);
}

static void refuses_unknown_curves(void **state)
{
    (void)state;
    const struct orl_frame_range range = {0, 1, 1};
    struct said said;
    struct orl_log log = log_to(&said);
    if (!make("clip.mkv", "format=yuv444p,setparams=color_trc=log100", ""))
        skip();
    char *clip = test_path(dir, "clip.mkv");
    assert_int_equal(orl_video_decode(&log, NULL, clip, &range, dir), ORL_ERR_UNSUPPORTED);
    assert_non_null(strstr(said.text, "its transfer curve, log100"));
    free(clip);
}

static void squares_pixels_and_deinterlaces(void **state)
{
    (void)state;
    struct orl_video video;
    char *clip = test_path(dir, "clip.mp4");
    if (!make("clip.mp4", "format=yuv420p,setsar=1", ""))
        skip();
    assert_int_equal(orl_video_inspect(NULL, NULL, clip, true, &video), ORL_OK);
    assert_null(strstr(video.colours, "setsar"));
    assert_string_equal(video.first, "");
    assert_true(video.seconds > 0);
    assert_true(make("clip.mp4", "format=yuv420p,setsar=2/1,setfield=tff",
                     "-x264opts interlaced=1:tff=1"));
    assert_int_equal(orl_video_inspect(NULL, NULL, clip, false, &video), ORL_OK);
    assert_null(strstr(video.colours, "setsar"));
    assert_int_equal(orl_video_inspect(NULL, NULL, clip, true, &video), ORL_OK);
    assert_non_null(strstr(video.colours, "setsar=1"));
    assert_non_null(strstr(video.first, "bwdif"));
    char command[2048];
    struct orl_image frame;
    snprintf(command, sizeof command, "ffmpeg -nostdin -loglevel error -y -i %s -vf \"%s%snull\" "
             "-frames:v 1 %s/wide.png", clip, video.first, video.colours, dir);
    assert_int_equal(system(command), 0);
    char *wide = test_path(dir, "wide.png");
    assert_int_equal(orl_picture_read(NULL, wide, 3, &frame), ORL_OK);
    assert_int_equal(frame.width, 2 * W);
    assert_int_equal(frame.height, H);
    orl_image_finish(&frame);
    free(wide);
    free(clip);
}

// What is written says what it is, and comes back.
static void tags_what_it_writes(void **state)
{
    (void)state;
    char *clip = test_path(dir, "out.mp4"), command[1024];
    enum orl_result result = orl_video_encode(NULL, NULL, dir, 30, clip);
    if (result == ORL_ERR_NOT_FOUND)
        skip();
    assert_int_equal(result, ORL_OK);
    snprintf(command, sizeof command, "ffprobe -v error -show_entries stream=color_space,color_range,"
             "color_primaries,color_transfer -of csv=p=0 %s | "
             "grep -qx tv,bt709,iec61966-2-1,bt709", clip);
    assert_int_equal(system(command), 0);
    expect_patches("out.mp4");
    free(clip);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(follows_matrix_and_range, set_up, tear_down),
        cmocka_unit_test_setup_teardown(guesses_untagged_matrices, set_up, tear_down),
        cmocka_unit_test_setup_teardown(brings_hdr_and_wide_colours_to_srgb, set_up, tear_down),
        cmocka_unit_test_setup_teardown(shows_hlg_as_its_standard, set_up, tear_down),
        cmocka_unit_test_setup_teardown(refuses_unknown_curves, set_up, tear_down),
        cmocka_unit_test_setup_teardown(squares_pixels_and_deinterlaces, set_up, tear_down),
        cmocka_unit_test_setup_teardown(tags_what_it_writes, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
