#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

extern "C" {
#include "bridge/bridge.h"
}

namespace {

// Shares the image's pixels.
cv::Mat as_mat(const struct orl_image *image)
{
    int depth = image->type == ORL_PIXEL_F32 ? CV_32F : CV_8U;
    return cv::Mat(image->height, image->width, CV_MAKETYPE(depth, image->channels), image->data);
}

// Runs `filter` on matrices that share the pixels of `from` and `to`; whatever it
// throws becomes a result code and `to` is emptied.
template <typename Filter>
enum orl_result run(const struct orl_log *log, const struct orl_image *from, struct orl_image *to,
                    Filter filter)
{
    try {
        cv::Mat source = as_mat(from), target = as_mat(to);
        filter(source, target);
        if (target.data == to->data)
            return ORL_OK;
        orl_logf(log, ORL_LOG_ERROR, "OpenCV: result of another size or type");
    } catch (const std::bad_alloc &) {
        orl_image_finish(to);
        return orl_fail(log, ORL_ERR_MEMORY, "OpenCV: out of memory");
    } catch (const std::exception &error) {
        orl_logf(log, ORL_LOG_ERROR, "OpenCV: %s", error.what());
    } catch (...) {
        orl_logf(log, ORL_LOG_ERROR, "OpenCV: unknown failure");
    }
    orl_image_finish(to);
    return ORL_ERR_EXTERNAL;
}

} // namespace

enum orl_result orl_bridge_blur(const struct orl_log *log, const struct orl_image *image, int taps,
                                double sigma_px, struct orl_image *blurred)
{
    *blurred = orl_image();
    ORL_REQUIRE(log, image->type == ORL_PIXEL_F32 && image->data);
    ORL_REQUIRE(log, taps >= 1 && taps <= 255 && taps % 2 == 1 && sigma_px > 0);
    enum orl_result result = orl_image_init(log, blurred, image->width, image->height,
                                            image->channels, ORL_PIXEL_F32);
    if (result != ORL_OK)
        return result;
    return run(log, image, blurred, [&](const cv::Mat &source, cv::Mat &target) {
        cv::GaussianBlur(source, target, cv::Size(taps, taps), sigma_px, sigma_px,
                         cv::BORDER_REPLICATE);
    });
}

enum orl_result orl_bridge_resize(const struct orl_log *log, const struct orl_image *image,
                                  int width, int height, struct orl_image *resized)
{
    *resized = orl_image();
    ORL_REQUIRE(log, image->data);
    enum orl_result result =
        orl_image_init(log, resized, width, height, image->channels, image->type);
    if (result != ORL_OK)
        return result;
    bool shrinks = width <= image->width && height <= image->height;
    return run(log, image, resized, [&](const cv::Mat &source, cv::Mat &target) {
        cv::resize(source, target, target.size(), 0, 0,
                   shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
    });
}
