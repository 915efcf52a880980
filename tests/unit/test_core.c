// Results, log, memory, images, progress.
#include "test.h"

#include <string.h>

#include "oriel/image.h"
#include "core/memory.h"
#include "oriel/progress.h"

static void result_names(void **state)
{
    (void)state;
    assert_int_equal(ORL_OK, 0);
    assert_string_equal(orl_result_name(ORL_OK), "ORL_OK");
    assert_string_equal(orl_result_name(ORL_ERR_IO), "ORL_ERR_IO");
    assert_string_equal(orl_result_name(ORL_ERR_CANCELLED), "ORL_ERR_CANCELLED");
    assert_string_equal(orl_result_message(ORL_ERR_MEMORY), "out of memory");
    assert_string_equal(orl_result_name(ORL_RESULT_COUNT), "unknown");
    assert_string_equal(orl_result_message((enum orl_result)-1), "unknown");
    for (int i = 0; i < ORL_RESULT_COUNT; i++)
        for (int k = 0; k < i; k++)
            assert_string_not_equal(orl_result_name((enum orl_result)i),
                                    orl_result_name((enum orl_result)k));
}

// --- log ---

struct heard {
    int count;
    enum orl_log_level level;
    char message[8192];
};

static void hear(void *priv, enum orl_log_level level, const char *message)
{
    struct heard *heard = priv;
    heard->count++;
    heard->level = level;
    snprintf(heard->message, sizeof heard->message, "%s", message);
}

static void log_levels(void **state)
{
    (void)state;
    struct heard heard = {0};
    struct orl_log log = {.level = ORL_LOG_WARNING, .print = hear, .priv = &heard};
    orl_logf(&log, ORL_LOG_INFO, "dropped");
    assert_int_equal(heard.count, 0);
    orl_logf(&log, ORL_LOG_WARNING, "%d of %s", 3, "them");
    assert_int_equal(heard.count, 1);
    assert_int_equal(heard.level, ORL_LOG_WARNING);
    assert_string_equal(heard.message, "3 of them");
    assert_int_equal(orl_fail(&log, ORL_ERR_DATA, "no %s", "good"), ORL_ERR_DATA);
    assert_int_equal(heard.level, ORL_LOG_ERROR);
    assert_string_equal(heard.message, "no good");
    assert_int_equal(orl_fail(NULL, ORL_ERR_GPU, "silence"), ORL_ERR_GPU);
}

static void long_messages_are_cut(void **state)
{
    (void)state;
    struct heard heard = {0};
    struct orl_log log = {.level = ORL_LOG_ERROR, .print = hear, .priv = &heard};
    char *text = calloc(1, 10001);
    memset(text, 'x', 10000);
    orl_logf(&log, ORL_LOG_ERROR, "%s", text);
    assert_int_equal(strlen(heard.message), 4095);
    free(text);
}

// --- memory ---

static void arrays(void **state)
{
    (void)state;
    struct heard heard = {0};
    struct orl_log log = {.level = ORL_LOG_ERROR, .print = hear, .priv = &heard};
    int *numbers = orl_array(&log, 100, sizeof *numbers);
    for (int i = 0; i < 100; i++)
        assert_int_equal(numbers[i], 0);
    free(numbers);
    void *nothing = orl_array(&log, 0, 8);
    assert_non_null(nothing);
    free(nothing);
    assert_int_equal(heard.count, 0);
    volatile size_t huge = SIZE_MAX / 2; // hidden from the compiler's own check
    assert_null(orl_array(&log, huge, 8));
    assert_int_equal(heard.count, 1);
}

static void growing(void **state)
{
    (void)state;
    int *numbers = NULL;
    size_t capacity = 0;
    for (int i = 0; i < 1000; i++) {
        assert_int_equal(orl_grow(NULL, (void **)&numbers, &capacity, (size_t)i + 1, sizeof(int)),
                         ORL_OK);
        assert_true(capacity > (size_t)i);
        numbers[i] = i;
    }
    for (int i = 0; i < 1000; i++)
        assert_int_equal(numbers[i], i);
    int *before = numbers;
    size_t capacity_before = capacity;
    assert_int_equal(orl_grow(NULL, (void **)&numbers, &capacity, SIZE_MAX / 2, sizeof(int)),
                     ORL_ERR_MEMORY);
    assert_int_equal(orl_grow(NULL, (void **)&numbers, &capacity, SIZE_MAX, sizeof(int)),
                     ORL_ERR_MEMORY);
    assert_ptr_equal(numbers, before); // what was there stays
    assert_int_equal(capacity, capacity_before);
    free(numbers);
}

static void strings(void **state)
{
    (void)state;
    char *copy = orl_strdup(NULL, "abc"), *text = orl_format(NULL, "%s-%03d", copy, 7);
    assert_string_equal(text, "abc-007");
    free(copy);
    free(text);
}

// --- images ---

static void image_limits(void **state)
{
    (void)state;
    const struct {
        int width, height, channels;
    } wrong[] = {{0, 1, 1}, {1, 0, 1}, {-1, 1, 1}, {1, 1, 0}, {1, 1, 5},
                 {ORL_IMAGE_MAX_SIDE + 1, 1, 1}, {1, ORL_IMAGE_MAX_SIDE + 1, 1}};
    struct orl_image image;
    for (size_t i = 0; i < ORL_COUNT(wrong); i++) {
        memset(&image, 0xff, sizeof image);
        assert_int_equal(orl_image_init(NULL, &image, wrong[i].width, wrong[i].height,
                                        wrong[i].channels, ORL_PIXEL_U8), ORL_ERR_ARGUMENT);
        assert_null(image.data);
        assert_int_equal(image.width, 0);
    }
    assert_int_equal(orl_image_init(NULL, &image, ORL_IMAGE_MAX_SIDE, 1, 4, ORL_PIXEL_U8), ORL_OK);
    assert_int_equal(orl_image_bytes(&image), 4 * ORL_IMAGE_MAX_SIDE);
    orl_image_finish(&image);
    assert_null(image.data);
    orl_image_finish(&image); // twice is fine
    orl_image_finish(NULL);
}

static void image_sizes(void **state)
{
    (void)state;
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, 5, 7, 3, ORL_PIXEL_F32), ORL_OK);
    assert_int_equal(orl_image_bytes(&image), 5 * 7 * 3 * 4);
    for (int i = 0; i < 5 * 7 * 3; i++)
        assert_true(image.f32[i] == 0);
    orl_image_finish(&image);
}

// --- progress ---

struct asked {
    int reports;
    bool stop;
};

static void count_report(void *priv, const char *step, double done, double total,
                         const char *detail)
{
    struct asked *asked = priv;
    asked->reports++;
    assert_string_equal(step, "step");
    assert_true(done <= total);
    assert_null(detail);
}

static bool ask(void *priv)
{
    return ((struct asked *)priv)->stop;
}

static void progress_is_optional(void **state)
{
    (void)state;
    struct asked asked = {0};
    struct orl_progress progress = {.report = count_report, .cancelled = ask, .priv = &asked};
    struct orl_progress silent = {0};
    orl_progress_report(NULL, "step", 0, 1, NULL);
    orl_progress_report(&silent, "step", 0, 1, NULL);
    assert_false(orl_progress_cancelled(NULL));
    assert_false(orl_progress_cancelled(&silent));
    orl_progress_report(&progress, "step", 1, 2, NULL);
    assert_int_equal(asked.reports, 1);
    assert_false(orl_progress_cancelled(&progress));
    asked.stop = true;
    assert_true(orl_progress_cancelled(&progress));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(result_names),
        cmocka_unit_test(log_levels),
        cmocka_unit_test(long_messages_are_cut),
        cmocka_unit_test(arrays),
        cmocka_unit_test(growing),
        cmocka_unit_test(strings),
        cmocka_unit_test(image_limits),
        cmocka_unit_test(image_sizes),
        cmocka_unit_test(progress_is_optional),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
