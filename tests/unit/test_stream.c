// Pictures cut out of a stream of bytes that is made by hand.
#include "io/stream.h"
#include "test.h"

// The smallest streams of markers and chunks; nothing decodes them.
static const uint8_t png_file[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n',
                                   0, 0, 0, 5, 'I', 'D', 'A', 'T', 'I', 'E', 'N', 'D', 0, 1, 2, 3, 4,
                                   0, 0, 0, 0, 'I', 'E', 'N', 'D', 5, 6, 7, 8};
// A segment with the end of a thumbnail in it, and a scan with an escaped 0xff and a restart marker.
static const uint8_t jpeg_file[] = {0xff, 0xd8, 0xff, 0xe1, 0, 6, 0xff, 0xd8, 0xff, 0xd9,
                                    0xff, 0xda, 0, 2, 1, 0xff, 0, 2, 0xff, 0xd3, 3, 0xff, 0xd9};

static void check(const uint8_t *bytes, size_t count, bool found, size_t begin, size_t length)
{
    size_t is_begin, is_length;
    uint8_t *exact = malloc(count); // so that a sanitizer sees what reads past the end
    assert_non_null(exact);
    memcpy(exact, bytes, count);
    assert_int_equal(orl_stream_find_picture(exact, count, &is_begin, &is_length), found);
    assert_int_equal(is_begin, begin);
    assert_int_equal(is_length, length);
    free(exact);
}

static void pictures_end_where_their_files_do(void **state)
{
    (void)state;
    uint8_t stream[sizeof png_file + sizeof jpeg_file + 3] = {'x', 0xff, 0};
    memcpy(stream + 3, jpeg_file, sizeof jpeg_file);
    memcpy(stream + 3 + sizeof jpeg_file, png_file, sizeof png_file);
    check(stream, sizeof stream, true, 3, sizeof jpeg_file);
    check(stream + 3 + sizeof jpeg_file, sizeof png_file, true, 0, sizeof png_file);
    check(jpeg_file, sizeof jpeg_file, true, 0, sizeof jpeg_file);
    // However many bytes of it are there yet, it is waited for.
    for (size_t count = 4; count < 3 + sizeof jpeg_file; count++)
        check(stream, count, false, 3, 0);
    for (size_t count = 1; count < sizeof png_file; count++)
        check(png_file, count, false, 0, 0);
    check(stream, 3, false, 3, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_end_where_their_files_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
