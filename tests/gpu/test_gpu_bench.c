// What benchmarks read from the device: memory by owner, and spans of passes.
#include <string.h>

#include "gpu_test.h"

static struct orl_gpu *gpu;

static const struct orl_gpu_memory *find(const struct orl_gpu_memory *rows, size_t count,
                                         const char *tag)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(rows[i].tag, tag) == 0)
            return &rows[i];
    return NULL;
}

static void counts_memory_by_owner_and_tag(void **state)
{
    (void)state;
    struct orl_gpu_memory rows[16];
    size_t before = orl_gpu_bytes(gpu), known = orl_gpu_memory(gpu, rows, 16);
    struct orl_buf *a, *b;
    struct orl_tex *tex;
    const struct orl_tex_params params = {.width = 8, .height = 4, .levels = 2, .format = GL_RGBA8,
                                          .owner = ORL_OWNER_PHOTOGRAPHS,
                                          .tag = "bench pictures"};
    size_t photographs = orl_gpu_owner_bytes(gpu, ORL_OWNER_PHOTOGRAPHS);
    size_t points = orl_gpu_owner_bytes(gpu, ORL_OWNER_POINTS);
    assert_int_equal(orl_buf_create(gpu, ORL_OWNER_FRAME, "bench words", 400, NULL, GL_R32UI, &a), ORL_OK);
    assert_int_equal(orl_buf_create(gpu, ORL_OWNER_POINTS, "bench words", 80, NULL, 0, &b), ORL_OK);
    assert_int_equal(orl_tex_create(gpu, &params, &tex), ORL_OK);
    size_t count = orl_gpu_memory(gpu, rows, 16);
    assert_int_equal(count, known + 3); // one tag of two owners is two rows
    assert_int_equal(find(rows, count, "bench words")->bytes, 400);
    assert_int_equal(find(rows, count, "bench words")->owner, ORL_OWNER_FRAME);
    assert_int_equal(find(rows, count, "bench words")->objects, 1);
    assert_int_equal(orl_gpu_owner_bytes(gpu, ORL_OWNER_POINTS), points + 80);
    assert_int_equal(orl_gpu_owner_bytes(gpu, ORL_OWNER_PHOTOGRAPHS), photographs + 160);
    assert_int_equal(find(rows, count, "bench pictures")->bytes, 4 * (8 * 4 + 4 * 2));
    assert_int_equal(orl_gpu_bytes(gpu), before + 480 + 160);
    orl_buf_destroy(gpu, &a);
    count = orl_gpu_memory(gpu, rows, 16);
    assert_int_equal(find(rows, count, "bench words")->bytes, 80);
    orl_buf_destroy(gpu, &b);
    orl_tex_destroy(gpu, &tex);
    assert_int_equal(orl_gpu_memory(gpu, rows, 16), known);
    assert_int_equal(orl_gpu_bytes(gpu), before);
}

static void one_pass(const char *name, struct orl_buf *buf)
{
    orl_pass_begin(gpu, name);
    orl_buf_fill(buf, 7);
    orl_pass_end(gpu);
}

static void traces_passes(void **state)
{
    (void)state;
    struct orl_buf *buf;
    struct orl_pass_span spans[3];
    struct orl_pass_trace trace = {.spans = spans, .capacity = 3};
    assert_int_equal(orl_buf_create(gpu, ORL_OWNER_FRAME, "bench words", 1 << 16, NULL, 0, &buf), ORL_OK);
    one_pass("untimed", buf);
    orl_gpu_time_passes(gpu, true);
    orl_gpu_trace_passes(gpu, &trace);
    static const char *const names[] = {"one", "two", "one", "one"};
    for (size_t i = 0; i < 4; i++)
        one_pass(names[i], buf);
    orl_gpu_trace_passes(gpu, NULL);
    one_pass("untraced", buf);
    orl_gpu_time_passes(gpu, false);
    assert_int_equal(trace.count, 3);
    assert_int_equal(trace.dropped, 1);
    for (size_t i = 0; i < 3; i++) {
        assert_string_equal(spans[i].name, names[i]);
        assert_true(spans[i].cpu_start_s <= spans[i].cpu_end_s);
        assert_true(spans[i].gpu_start_s <= spans[i].gpu_end_s);
        assert_true(i == 0 || spans[i - 1].gpu_end_s <= spans[i].gpu_start_s);
        assert_true(i == 0 || spans[i - 1].cpu_end_s <= spans[i].cpu_start_s);
    }
    struct orl_pass_time times[8];
    assert_int_equal(orl_gpu_take_times(gpu, times, 8), 3);
    assert_int_equal(times[0].count, 3);
    orl_buf_destroy(gpu, &buf);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_memory_by_owner_and_tag),
        cmocka_unit_test(traces_passes),
    };
    gpu = gpu_test_device();
    int failures = cmocka_run_group_tests(tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failures;
}
