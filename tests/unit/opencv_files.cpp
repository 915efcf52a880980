#include "opencv_files.h"

#include <cstdlib>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

bool test_opencv_read_rgb(const char *path, int width, int height, float *rgb)
{
    setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 1); // later versions read no EXR without
    cv::Mat stored = cv::imread(path, cv::IMREAD_UNCHANGED), colour;
    if (stored.cols != width || stored.rows != height || stored.channels() != 3)
        return false;
    cv::cvtColor(stored, colour, cv::COLOR_BGR2RGB);
    cv::Mat to(height, width, CV_32FC3, rgb);
    colour.convertTo(to, CV_32F);
    return to.data == reinterpret_cast<unsigned char *>(rgb);
}

bool test_opencv_write_rgb16(const char *path, int width, int height, const unsigned short *rgb)
{
    cv::Mat bgr;
    cv::cvtColor(cv::Mat(height, width, CV_16UC3, const_cast<unsigned short *>(rgb)), bgr,
                 cv::COLOR_RGB2BGR);
    return cv::imwrite(path, bgr);
}
