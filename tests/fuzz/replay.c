// Runs a target on every file of a folder: replay TARGET FOLDER.
#include <stdio.h>
#include <stdlib.h>

#include "core/file.h"
#include "fuzz.h"

int main(int argc, char **argv)
{
    const struct fuzz_target *target = argc == 3 ? fuzz_target_find(argv[1]) : NULL;
    struct orl_log log = orl_log_stderr(ORL_LOG_INFO);
    struct orl_names names;
    if (!target || orl_dir_list(&log, argv[2], &names) != ORL_OK)
        return 2;
    fuzz_limit_memory();
    size_t count = 0;
    for (size_t i = 0; i < names.count; i++) {
        char *path = orl_path_join(&log, argv[2], names.items[i]);
        uint8_t *data;
        size_t size;
        if (!path || orl_file_read(&log, path, 1 << 24, &data, &size) != ORL_OK)
            return 1;
        target->run(data, size);
        count++;
        free(data);
        free(path);
    }
    orl_names_finish(&names);
    printf("%s: %zu inputs\n", target->name, count);
    return count ? 0 : 1;
}
