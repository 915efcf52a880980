#include "preprocess/calibrate/vlad.h"

#include <flann/flann.h>
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"

enum { WORDS = ORL_VLAD_WORDS, SIZE = ORL_SIFT_SIZE, SAMPLES_MAX = 1 << 13, ITERATIONS = 11 };

// Every photograph gives the same number of its features, spread over their scales.
static enum orl_result sample(const struct orl_log *log, const struct orl_pair_photo *photos,
                              size_t count, float **samples, size_t *sampled)
{
    size_t each = count ? SAMPLES_MAX / count : 0;
    each = each < 1 ? 1 : each > ORL_PAIR_FEATURES ? ORL_PAIR_FEATURES : each;
    *sampled = 0;
    *samples = orl_array(log, count * each, SIZE * sizeof **samples);
    ORL_TRY_MEMORY(*samples);
    for (size_t p = 0; p < count; p++) {
        const struct orl_features *features = &photos[p].features;
        size_t take = features->count < each ? features->count : each;
        for (size_t i = 0; i < take; i++) {
            const uint8_t *from = features->descriptors + i * features->count / take * SIZE;
            float *to = *samples + (*sampled)++ * SIZE;
            for (size_t k = 0; k < SIZE; k++)
                to[k] = from[k];
        }
    }
    return ORL_OK;
}

// Cluster centres of the samples: k-means in one level.
static enum orl_result find_words(const struct orl_log *log, const struct orl_pair_photo *photos,
                                  size_t count, uint32_t seed, float *words, size_t *word_count)
{
    float *samples;
    size_t sampled;
    enum orl_result result = sample(log, photos, count, &samples, &sampled);
    *word_count = 0;
    // With fewer features than words there is nothing to aggregate.
    if (result == ORL_OK && sampled > WORDS) {
        struct FLANNParameters flann = DEFAULT_FLANN_PARAMETERS;
        flann.branching = WORDS;
        flann.iterations = ITERATIONS;
        flann.centers_init = FLANN_CENTERS_KMEANSPP;
        flann.random_seed = (long)seed + 1; // FLANN leaves its generator as it is for 0
        flann.log_level = FLANN_LOG_NONE;
        int found = flann_compute_cluster_centers_float(samples, (int)sampled, SIZE, WORDS, words,
                                                        &flann);
        if (found < 1)
            result = orl_fail(log, ORL_ERR_EXTERNAL, "FLANN cannot cluster the features");
        else
            *word_count = (size_t)found;
    }
    free(samples);
    return result;
}

// Several sums at once, which the compiler may not make of one: their order would be another.
enum { LANES = 8 };

static float total_of(const float sum[LANES])
{
    float total = 0;
    for (int lane = 0; lane < LANES; lane++)
        total += sum[lane];
    return total;
}

static size_t nearest_word(const float *words, size_t word_count, const uint8_t *descriptor)
{
    size_t nearest = 0;
    float least = INFINITY;
    for (size_t w = 0; w < word_count; w++) {
        float sum[LANES] = {0};
        for (size_t k = 0; k < SIZE; k += LANES) {
            for (size_t lane = 0; lane < LANES; lane++) {
                float d = descriptor[k + lane] - words[w * SIZE + k + lane];
                sum[lane] += d * d;
            }
        }
        float total = total_of(sum);
        if (total < least)
            least = total, nearest = w;
    }
    return nearest;
}

static void normalise(float *vector, size_t size)
{
    double sum = 0;
    for (size_t k = 0; k < size; k++)
        sum += (double)vector[k] * vector[k];
    for (size_t k = 0; k < size && sum > 0; k++)
        vector[k] /= (float)sqrt(sum);
}

// Each word's sum is normalised for itself (Arandjelovic and Zisserman 2013, "All about VLAD"), so
// that what repeats in a photograph, as windows do, does not outweigh the rest.
static void aggregate(const struct orl_features *photo, const float *words, size_t word_count,
                      float *vector)
{
    for (size_t i = 0; i < photo->count && word_count; i++) {
        const uint8_t *descriptor = photo->descriptors + i * SIZE;
        size_t w = nearest_word(words, word_count, descriptor);
        for (size_t k = 0; k < SIZE; k++)
            vector[w * SIZE + k] += descriptor[k] - words[w * SIZE + k];
    }
    for (size_t w = 0; w < WORDS; w++)
        normalise(vector + w * SIZE, SIZE);
    normalise(vector, ORL_VLAD_SIZE);
}

enum orl_result orl_vlad(const struct orl_log *log, const struct orl_pair_photo *photos,
                         size_t count, uint32_t seed, float **vectors)
{
    size_t word_count;
    float *words = orl_array(log, WORDS, SIZE * sizeof *words);
    *vectors = orl_array(log, count, ORL_VLAD_SIZE * sizeof **vectors);
    enum orl_result result = words && *vectors ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, find_words(log, photos, count, seed, words, &word_count));
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        aggregate(&photos[i].features, words, word_count, *vectors + i * ORL_VLAD_SIZE);
    free(words);
    if (result != ORL_OK) {
        free(*vectors);
        *vectors = NULL;
    }
    return result;
}

float orl_vlad_similarity(const float *vectors, size_t a, size_t b)
{
    const float *x = vectors + a * ORL_VLAD_SIZE, *y = vectors + b * ORL_VLAD_SIZE;
    float sum[LANES] = {0};
    for (size_t k = 0; k < ORL_VLAD_SIZE; k += LANES)
        for (size_t lane = 0; lane < LANES; lane++)
            sum[lane] += x[k + lane] * y[k + lane];
    return total_of(sum);
}
