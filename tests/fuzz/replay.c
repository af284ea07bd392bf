/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs a fuzz target over files, for machines without libFuzzer and for ctest: program
 * FILE|FOLDER... */
#include "fuzz.h"
#include <dirent.h>

enum { LARGEST = 1 << 20, PATH_LENGTH = 1024 };

static int replay_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    uint8_t *data = malloc(LARGEST);
    if (!file || !data) {
        fprintf(stderr, "cannot read %s\n", path);
        if (file) fclose(file);
        free(data);
        return 0;
    }
    const size_t size = fread(data, 1, LARGEST, file);
    fclose(file);
    printf("%s\n", path);
    fflush(stdout);
    uint8_t *exact = malloc(size ? size : 1); /* so that a sanitizer reports reads behind its end */
    if (exact) {
        memcpy(exact, data, size);
        LLVMFuzzerTestOneInput(exact, size);
    }
    free(exact);
    free(data);
    return exact != NULL;
}

static int replay_folder(DIR *folder, const char *path)
{
    int count = 0;
    const struct dirent *entry;
    while ((entry = readdir(folder))) {
        char inner[PATH_LENGTH];
        if (entry->d_name[0] == '.') continue;
        snprintf(inner, sizeof inner, "%s/%s", path, entry->d_name);
        count += replay_file(inner);
    }
    return count;
}

int main(int argc, char **argv)
{
    int count = 0;
    for (int k = 1; k < argc; k++) {
        DIR *folder = opendir(argv[k]);
        count += folder ? replay_folder(folder, argv[k]) : replay_file(argv[k]);
        if (folder) closedir(folder);
    }
    printf("%d inputs replayed\n", count);
    return count == 0;
}
