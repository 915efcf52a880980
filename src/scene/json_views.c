#include "scene/json_views.h"

#include "oriel/image.h"
#include "core/json.h"

bool orl_json_rows(const json_t *array, size_t rows, size_t columns, double *out)
{
    if (!json_is_array(array) || json_array_size(array) != rows)
        return false;
    for (size_t i = 0; i < rows; i++)
        if (!orl_json_read_numbers(json_array_get(array, i), columns, out + i * columns))
            return false;
    return true;
}

int orl_json_side(const json_t *entry, const char *key)
{
    json_int_t side = json_integer_value(json_object_get(entry, key));
    return side >= 1 && side <= ORL_IMAGE_MAX_SIDE ? (int)side : 0;
}

bool orl_json_inria_view(const json_t *entry, struct orl_view *view)
{
    double axes[3][3], centre[3];
    int width = orl_json_side(entry, "width"), height = orl_json_side(entry, "height");
    view->camera = (struct orl_camera){
        .width = width, .height = height, .cx = 0.5 * width, .cy = 0.5 * height,
        .fx = json_number_value(json_object_get(entry, "fx")),
        .fy = json_number_value(json_object_get(entry, "fy"))};
    if (!orl_json_rows(json_object_get(entry, "rotation"), 3, 3, &axes[0][0]) ||
        !orl_json_read_numbers(json_object_get(entry, "position"), 3, centre))
        return false;
    (void)orl_pose_from_axes(axes, centre, &view->cam_from_world); // the caller checks
    return true;
}
