// FLIP against the authors' own program (FLIP.h of github.com/NVlabs/flip) on these pictures.
#include "test.h"

#include <math.h>

#include "eval/metrics.h"

typedef int pattern(int x, int y, int c);

static struct orl_image paint(int width, int height, pattern *at)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, width, height, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < width * height * 3; i++)
        image.u8[i] = (uint8_t)at(i / 3 % width, i / 3 / width, i % 3);
    return image;
}

static double compare(int width, int height, pattern *one, pattern *two)
{
    struct orl_image a = paint(width, height, one), b = paint(width, height, two);
    double mean;
    assert_int_equal(orl_flip_compare(NULL, &a, &b, &mean), ORL_OK);
    orl_image_finish(&a);
    orl_image_finish(&b);
    return mean;
}

static int noise(int x, int y, int c)
{
    return (x * 7 + y * 13 + c * 50 + (x * y) % 11 * 5) % 256;
}

static int noise_changed(int x, int y, int c)
{
    int value = noise(x, y, c) * 3 / 4 + 20 + ((x * 5 + y * 3 + c) % 7 - 3) * 4;
    return value < 0 ? 0 : value > 255 ? 255 : value;
}

static int gray100(int x, int y, int c)
{
    (void)x, (void)y, (void)c;
    return 100;
}

static int gray110(int x, int y, int c)
{
    return gray100(x, y, c) + 10;
}

static int gray140(int x, int y, int c)
{
    return gray100(x, y, c) + 40;
}

static int green(int x, int y, int c)
{
    (void)x, (void)y;
    return c == 1 ? 255 : 0;
}

static int blue(int x, int y, int c)
{
    (void)x, (void)y;
    return c == 2 ? 255 : 0;
}

static int waves(int x, int y, int c)
{
    return (int)lround(128 + 60 * sin(0.21 * x + 0.1 * c) + 50 * cos(0.17 * y - 0.3 * c));
}

static int waves_moved(int x, int y, int c)
{
    return waves(x + 2, y + 1, c);
}

static int step(int x, int y, int c)
{
    (void)y, (void)c;
    return x < 20 ? 40 : 200;
}

static int step_moved(int x, int y, int c)
{
    return step(x - 3, y, c);
}

static void agrees_with_the_authors(void **state)
{
    (void)state;
    assert_float_equal(compare(24, 19, noise, noise_changed), 0.4378499, 1e-4);
    assert_float_equal(compare(24, 19, gray100, gray110), 0.1534757, 1e-4);
    assert_float_equal(compare(40, 30, waves, waves_moved), 0.2817253, 1e-4);
    assert_float_equal(compare(40, 30, step, step_moved), 0.1312885, 1e-4);
    assert_float_equal(compare(24, 19, green, blue), 1, 1e-4);
}

static void same_symmetric_monotone(void **state)
{
    (void)state;
    assert_float_equal(compare(40, 30, waves, waves), 0, 0);
    assert_float_equal(compare(24, 19, noise, noise_changed), compare(24, 19, noise_changed, noise),
                       1e-12);
    assert_true(compare(24, 19, gray100, gray140) > compare(24, 19, gray100, gray110));
    assert_true(compare(3, 1, green, blue) > 0.99); // smaller than any filter
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_authors),
        cmocka_unit_test(same_symmetric_monotone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
