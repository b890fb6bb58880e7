/* For the drive by libFuzzer: with FUZZ_SEEDS=FOLDER in the environment the target writes its seeds there and ends. */
#include "fuzz/fuzz.h"

int LLVMFuzzerInitialize(int *count, char ***words);
int LLVMFuzzerInitialize(int *count, char ***words)
{
    static uint8_t data[FUZZ_LONGEST];
    const char *folder = getenv("FUZZ_SEEDS");
    size_t size;
    (void)count;
    (void)words;
    for (int i = 0; folder != NULL && (size = fuzz_seed(i, data)) > 0; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/seed-%03d", folder, i);
        FILE *file = fopen(path, "wb");
        if (file == NULL || fwrite(data, 1, size, file) != size || fclose(file) != 0) {
            perror(path);
            exit(3);
        }
    }
    if (folder != NULL) {
        exit(0);
    }
    return 0;
}
