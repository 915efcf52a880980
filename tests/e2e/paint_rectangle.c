// Paints a rectangle of one grey value over a photograph, as something before the camera.
//     paint_rectangle IN OUT.jpg LEFT TOP WIDTH HEIGHT VALUE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/picture.h"

static void paint(struct orl_image *image, const char *const numbers[5])
{
    int left = atoi(numbers[0]), top = atoi(numbers[1]);
    int right = left + atoi(numbers[2]), bottom = top + atoi(numbers[3]);
    for (int y = top; y < bottom && y < image->height; y++)
        for (int x = left; x < right && x < image->width; x++)
            memset(&image->u8[3 * (y * image->width + x)], atoi(numbers[4]), 3);
}

int main(int argc, char **argv)
{
    struct orl_image image;
    struct orl_picture_info info; // so that the photograph still is of its camera
    if (argc != 8) {
        fprintf(stderr, "usage: paint_rectangle IN OUT.jpg LEFT TOP WIDTH HEIGHT VALUE\n");
        return 2;
    }
    enum orl_result result = orl_picture_read(NULL, argv[1], 3, &image);
    if (result == ORL_OK)
        result = orl_picture_inspect(NULL, argv[1], &info);
    if (result == ORL_OK) {
        paint(&image, (const char *const *)&argv[3]);
        result = orl_jpeg_write(NULL, argv[2], &image, 95, &info.exif);
    }
    orl_image_finish(&image);
    return result == ORL_OK ? 0 : 1;
}
