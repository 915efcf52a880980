#include <algorithm>
#include <cmath>
#include <climits>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/photo.hpp>

extern "C" {
#include "bridge/bridge.h"
}

namespace {

// A matrix that shares the image's pixels.
cv::Mat as_mat(const struct orl_image *image)
{
    int depth = image->type == ORL_PIXEL_F32 ? CV_32F : CV_8U;
    return cv::Mat(image->height, image->width, CV_MAKETYPE(depth, image->channels), image->data);
}

bool is(const struct orl_image *image, enum orl_pixel type, int channels)
{
    return image->type == type && image->channels == channels;
}

struct shape {
    int width, height, channels;
    enum orl_pixel type;
};

// Makes `to`, and runs `filter` on matrices that share the pixels of `from` and `to`. An exception becomes a result code
// and empties `to`. fits: `from` is what the filter takes.
template <typename Filter>
enum orl_result run(const struct orl_log *log, bool fits, const struct orl_image *from, const shape &made,
                    struct orl_image *to, Filter filter)
{
    *to = orl_image();
    ORL_REQUIRE(log, fits && from->data);
    enum orl_result result = orl_image_init(log, to, made.width, made.height, made.channels, made.type);
    if (result != ORL_OK)
        return result;
    result = ORL_ERR_EXTERNAL;
    try {
        cv::Mat source = as_mat(from), target = as_mat(to);
        filter(source, target);
        if (target.data == to->data)
            return ORL_OK;
        orl_logf(log, ORL_LOG_ERROR, "OpenCV: result of another size or type");
    } catch (const std::bad_alloc &) {
        result = orl_fail(log, ORL_ERR_MEMORY, "OpenCV: out of memory");
    } catch (const std::exception &error) {
        orl_logf(log, ORL_LOG_ERROR, "OpenCV: %s", error.what());
    } catch (...) {
        orl_logf(log, ORL_LOG_ERROR, "OpenCV: unknown failure");
    }
    orl_image_finish(to);
    return result;
}

// Silences a warning that OpenCV prints about the tone mapping operators' own arithmetic.
struct quiet {
    cv::utils::logging::LogLevel before =
        cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_ERROR);
    ~quiet() { cv::utils::logging::setLogLevel(before); }
};

// OpenCV's Mantiuk maps the brightest pixel to white, so that a single glint darkens the rest. This
// lets the brightest hundredth clip instead.
void anchor_white(cv::Mat &rgb)
{
    std::vector<float> peaks(rgb.total());
    const cv::Vec3f *pixels = rgb.ptr<cv::Vec3f>();
    for (size_t i = 0; i < peaks.size(); i++)
        peaks[i] = std::max({pixels[i][0], pixels[i][1], pixels[i][2], 0.f});
    auto at = peaks.begin() + static_cast<std::ptrdiff_t>(peaks.size() * 99 / 100);
    std::nth_element(peaks.begin(), at, peaks.end());
    if (*at > 0)
        cv::min(rgb * (1 / *at), cv::Scalar::all(1), rgb);
}

// Sets pixels of `value` to its opposite where they form a connected piece of less than `least`.
void flip_small(cv::Mat &mask, uchar value, int least, int connectivity)
{
    cv::Mat labels, stats, centroids;
    int count = cv::connectedComponentsWithStats(mask == value, labels, stats, centroids,
                                                 connectivity);
    for (int y = 0; y < mask.rows; y++)
        for (int x = 0; x < mask.cols; x++) {
            int label = labels.at<int>(y, x);
            if (label > 0 && label < count && stats.at<int>(label, cv::CC_STAT_AREA) < least)
                mask.at<uchar>(y, x) = static_cast<uchar>(255 - value);
        }
}

cv::Mat disc(int diameter)
{
    return cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(diameter, diameter));
}

} // namespace

enum orl_result orl_bridge_blur(const struct orl_log *log, const struct orl_image *image, int taps,
                                double sigma_px, struct orl_image *blurred)
{
    bool fits = image->type == ORL_PIXEL_F32 && taps >= 1 && taps <= 255 && taps % 2 == 1 && sigma_px > 0;
    return run(log, fits, image, {image->width, image->height, image->channels, ORL_PIXEL_F32}, blurred,
               [&](const cv::Mat &source, cv::Mat &target) {
        cv::GaussianBlur(source, target, cv::Size(taps, taps), sigma_px, sigma_px,
                         cv::BORDER_REPLICATE);
    });
}

enum orl_result orl_bridge_median(const struct orl_log *log, const struct orl_image *image,
                                  struct orl_image *median)
{
    return run(log, is(image, ORL_PIXEL_F32, 1), image, {image->width, image->height, 1, ORL_PIXEL_F32}, median,
               [](const cv::Mat &source, cv::Mat &target) { cv::medianBlur(source, target, 5); });
}

enum orl_result orl_bridge_resize(const struct orl_log *log, const struct orl_image *image,
                                  int width, int height, struct orl_image *resized)
{
    bool shrinks = width <= image->width && height <= image->height;
    return run(log, true, image, {width, height, image->channels, image->type}, resized,
               [&](const cv::Mat &source, cv::Mat &target) {
        cv::resize(source, target, target.size(), 0, 0,
                   shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
    });
}

enum orl_result orl_bridge_reduce(const struct orl_log *log, const struct orl_image *image,
                                  int width, int height, struct orl_image *reduced)
{
    bool fits = width <= image->width && height <= image->height;
    return run(log, fits, image, {width, height, image->channels, image->type}, reduced,
               [&](const cv::Mat &source, cv::Mat &target) {
        // The variance of a box of width w is w * w / 12; that of a triangle of this height is twice it.
        cv::Mat blurred;
        cv::GaussianBlur(source, blurred, cv::Size(0, 0),
                         static_cast<double>(source.cols) / target.cols / std::sqrt(12.),
                         static_cast<double>(source.rows) / target.rows / std::sqrt(12.),
                         cv::BORDER_REPLICATE);
        cv::resize(blurred, target, target.size(), 0, 0, cv::INTER_AREA);
    });
}

enum orl_result orl_bridge_tonemap(const struct orl_log *log, const struct orl_image *image,
                                   enum orl_tonemap kind, struct orl_image *mapped)
{
    return run(log, is(image, ORL_PIXEL_F32, 3), image, {image->width, image->height, 3, ORL_PIXEL_F32}, mapped,
               [&](const cv::Mat &source, cv::Mat &target) {
        // The operators divide by the range and by the mean.
        double least = 0, most = 0;
        cv::minMaxLoc(source.reshape(1), &least, &most);
        if (!(most > least)) {
            target.setTo(cv::Scalar::all(most > 0 ? 1 : 0));
            return;
        }
        // Mantiuk's pyramid needs a minimum size.
        const int min_side = 8;
        cv::Mat bgr, out;
        cv::copyMakeBorder(source, bgr, 0, std::max(0, min_side - source.rows), 0,
                           std::max(0, min_side - source.cols), cv::BORDER_REPLICATE);
        cv::Ptr<cv::Tonemap> map;
        if (kind == ORL_TONEMAP_DRAGO)
            map = cv::createTonemapDrago();
        else
            map = cv::createTonemapMantiuk();
        quiet hush;
        map->process(bgr, out);
        out(cv::Rect(0, 0, source.cols, source.rows)).copyTo(target);
        // The operators subtract the least light and then divide by the remainder.
        cv::Mat dark;
        cv::inRange(source, cv::Scalar::all(least), cv::Scalar::all(least), dark);
        target.setTo(cv::Scalar(), dark);
        if (kind == ORL_TONEMAP_MANTIUK)
            anchor_white(target);
    });
}

enum orl_result orl_bridge_response(const struct orl_log *log, enum orl_calibration kind,
                                    const struct orl_image *values, const double *exposures,
                                    float linear[3][256])
{
    struct orl_image curve;
    enum orl_result result = run(log, is(values, ORL_PIXEL_U8, 3), values, {1, 256, 3, ORL_PIXEL_F32}, &curve,
                                 [&](const cv::Mat &source, cv::Mat &target) {
        std::vector<cv::Mat> images;
        for (int y = 0; y < source.rows; y++)
            images.push_back(source.row(y));
        std::vector<float> times(exposures, exposures + source.rows);
        if (kind == ORL_CALIBRATION_DEBEVEC)
            cv::createCalibrateDebevec(source.cols)->process(images, target, times);
        else
            cv::createCalibrateRobertson(60)->process(images, target, times);
    });
    for (int v = 0; result == ORL_OK && v < 256; v++)
        for (int c = 0; c < 3; c++)
            linear[c][v] = curve.f32[3 * v + c];
    orl_image_finish(&curve);
    return result;
}

enum orl_result orl_bridge_remap(const struct orl_log *log, const struct orl_image *image,
                                 const struct orl_image *map, struct orl_image *remapped)
{
    bool fits = map->data && is(map, ORL_PIXEL_F32, 2);
    *remapped = orl_image();
    // OpenCV's remap stores row and column numbers in 16 bits.
    if (image->width >= SHRT_MAX || image->height >= SHRT_MAX)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "a picture of %dx%d pixels is too large here",
                        image->width, image->height);
    return run(log, fits, image, {map->width, map->height, image->channels, image->type}, remapped,
               [&](const cv::Mat &source, cv::Mat &target) {
        cv::remap(source, target, as_mat(map), cv::noArray(), cv::INTER_LINEAR,
                  cv::BORDER_CONSTANT, cv::Scalar());
    });
}

enum orl_result orl_bridge_clean_mask(const struct orl_log *log, const struct orl_image *mask,
                                      const struct orl_mask_cleaning *cleaning,
                                      struct orl_image *cleaned)
{
    return run(log, is(mask, ORL_PIXEL_U8, 1), mask, {mask->width, mask->height, 1, ORL_PIXEL_U8}, cleaned,
               [&](const cv::Mat &source, cv::Mat &target) {
        source.copyTo(target);
        if (cleaning->open_px > 1)
            cv::morphologyEx(target, target, cv::MORPH_OPEN, disc(cleaning->open_px));
        if (cleaning->close_px > 1)
            cv::morphologyEx(target, target, cv::MORPH_CLOSE, disc(cleaning->close_px));
        // Pieces touch at corners too, so holes may not: else a diagonal would part both.
        flip_small(target, 255, cleaning->min_px, 8);
        flip_small(target, 0, cleaning->hole_px, 4);
    });
}

enum orl_result orl_bridge_widen(const struct orl_log *log, const struct orl_image *mask, int reach,
                                 struct orl_image *widened)
{
    return run(log, is(mask, ORL_PIXEL_U8, 1), mask, {mask->width, mask->height, 1, ORL_PIXEL_U8}, widened,
               [&](const cv::Mat &source, cv::Mat &target) {
        cv::dilate(source, target, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
    });
}

enum orl_result orl_bridge_pieces(const struct orl_log *log, const struct orl_image *mask,
                                  int *largest, int *at_border)
{
    struct orl_image none; // the pieces are no picture
    *largest = *at_border = 0;
    enum orl_result result = run(log, is(mask, ORL_PIXEL_U8, 1), mask, {1, 1, 1, ORL_PIXEL_U8}, &none,
                                 [&](const cv::Mat &source, cv::Mat &) {
        cv::Mat labels, stats, centroids;
        int count = cv::connectedComponentsWithStats(source != 0, labels, stats, centroids, 8);
        for (int i = 1; i < count; i++) { // piece 0 is what is outside
            const int *piece = stats.ptr<int>(i), area = piece[cv::CC_STAT_AREA];
            bool inside = piece[cv::CC_STAT_LEFT] > 0 && piece[cv::CC_STAT_TOP] > 0 &&
                          piece[cv::CC_STAT_LEFT] + piece[cv::CC_STAT_WIDTH] < source.cols &&
                          piece[cv::CC_STAT_TOP] + piece[cv::CC_STAT_HEIGHT] < source.rows;
            *largest = std::max(*largest, area);
            *at_border = std::max(*at_border, inside ? 0 : area);
        }
    });
    orl_image_finish(&none);
    return result;
}

enum orl_result orl_bridge_label(const struct orl_log *log, const struct orl_image *mask,
                                 struct orl_image *labels, size_t *count)
{
    *count = 0;
    return run(log, is(mask, ORL_PIXEL_U8, 1), mask, {mask->width, mask->height, 1, ORL_PIXEL_F32}, labels,
               [&](const cv::Mat &source, cv::Mat &target) {
        cv::Mat numbers;
        int pieces = cv::connectedComponents(source != 0, numbers, 4, CV_32S);
        numbers.convertTo(target, CV_32F);
        *count = static_cast<size_t>(pieces - 1); // but for what is outside
    });
}

enum orl_result orl_bridge_distance(const struct orl_log *log, const struct orl_image *mask,
                                    struct orl_image *distance)
{
    return run(log, is(mask, ORL_PIXEL_U8, 1), mask, {mask->width, mask->height, 1, ORL_PIXEL_F32}, distance,
               [&](const cv::Mat &source, cv::Mat &target) {
        // Each distance is to the nearest pixel of the other side, half a pixel past the outline.
        cv::Mat to_subject, to_outside;
        double most = std::max(source.rows, source.cols);
        cv::distanceTransform(source == 0, to_subject, cv::DIST_L2, cv::DIST_MASK_PRECISE);
        cv::distanceTransform(source != 0, to_outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
        cv::min(to_subject, most, to_subject);
        cv::min(to_outside, most, to_outside);
        for (int y = 0; y < source.rows; y++)
            for (int x = 0; x < source.cols; x++) {
                float out = to_subject.at<float>(y, x), in = to_outside.at<float>(y, x);
                target.at<float>(y, x) = out > 0 ? out - 0.5f : 0.5f - in;
            }
    });
}
