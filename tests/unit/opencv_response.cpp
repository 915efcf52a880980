#include "opencv_response.h"

#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/photo.hpp>

bool opencv_response(bool robertson, const uint8_t *stack, int photos, int side,
                     const float *times, float curve[3][256])
{
    try {
        std::vector<cv::Mat> images;
        std::vector<float> seconds(times, times + photos);
        size_t size = 3 * static_cast<size_t>(side) * static_cast<size_t>(side);
        for (int i = 0; i < photos; i++)
            images.push_back(cv::Mat(side, side, CV_8UC3,
                                     const_cast<uint8_t *>(stack) + static_cast<size_t>(i) * size));
        cv::Mat found;
        if (robertson)
            cv::createCalibrateRobertson(60)->process(images, found, seconds);
        else // of all pixels
            cv::createCalibrateDebevec(side * side, 10)->process(images, found, seconds);
        for (int c = 0; c < 3; c++)
            for (int v = 0; v < 256; v++)
                curve[c][v] = found.at<cv::Vec3f>(v)[c];
        return true;
    } catch (...) {
        return false;
    }
}
