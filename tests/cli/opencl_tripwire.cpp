// Poses as an OpenCL platform: leaves a file behind as soon as the OpenCL loader opens it.
#include <cstdio>
#include <cstdlib>

[[gnu::constructor]] static void trip() {
    const char* path = std::getenv("WEFT_TRIPWIRE");
    if (path == nullptr) return;
    if (std::FILE* file = std::fopen(path, "w")) std::fclose(file);
}
