/* bin/weft and libexec/ld of the bundle: starts the program libexec/<name>.bin with the libraries that
 * came with it. Linked statically, so that it starts where there is no C library.
 *
 * The machine's own C library is preferred where it is new enough, and so is its C++ library: the
 * machine's OpenCL drivers are made for those. Where there is none, or an old one, the bundle's serve. */

#define _GNU_SOURCE
#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define HOST_LOADER "/lib64/ld-linux-x86-64.so.2"

static void fail(const char* what) {
    fprintf(stderr, "weft: error: the bundle cannot start: %s: %s\n", what, strerror(errno));
    exit(1);
}

static char* text(const char* format, ...) {
    char* result = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&result, format, arguments) < 0) fail("out of memory");
    va_end(arguments);
    return result;
}

static char* own_path(void) {
    char path[PATH_MAX] = {0};
    if (readlink("/proc/self/exe", path, sizeof(path) - 1) < 0) fail("/proc is missing");
    return text("%s", path);
}

/* "... stable release version 2.36." on the first line of `ld.so --version`; 0: no such loader. */
static int host_glibc_minor(void) {
    int ends[2];
    if (access(HOST_LOADER, X_OK) != 0 || pipe(ends) != 0) return 0;
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]);
        execl(HOST_LOADER, HOST_LOADER, "--version", (char*)NULL);
        _exit(127);
    }
    close(ends[1]);
    FILE* output = fdopen(ends[0], "r");
    char line[256] = {0};
    if (!fgets(line, sizeof(line), output)) line[0] = '\0';
    fclose(output);
    waitpid(child, NULL, 0);
    const char* version = strstr(line, "version 2.");
    return version ? atoi(version + strlen("version 2.")) : 0;
}

/* The 30 of libstdc++.so.6.0.30; 0: there is none. */
static int cxx_library_minor(const char* folder) {
    char target[PATH_MAX] = {0};
    char* link = text("%s/libstdc++.so.6", folder);
    const ssize_t length = readlink(link, target, sizeof(target) - 1);
    free(link);
    const char* version = length > 0 ? strstr(target, ".so.6.0.") : NULL;
    return version ? atoi(version + strlen(".so.6.0.")) : 0;
}

static int host_cxx_library_minor(void) {
    const char* folders[] = {"/usr/lib/x86_64-linux-gnu", "/lib/x86_64-linux-gnu", "/usr/lib64",
                             "/lib64", "/usr/lib"};
    for (size_t i = 0; i < sizeof(folders) / sizeof(*folders); ++i) {
        const int minor = cxx_library_minor(folders[i]);
        if (minor > 0) return minor;
    }
    return 0;
}

static void prepend(const char* variable, const char* value) {
    const char* before = getenv(variable);
    setenv(variable, before && *before ? text("%s:%s", value, before) : value, 1);
}

/* PoCL asks /sys for the cores and the memory, and ends the program where there is none. */
static void describe_machine(void) {
    if (access("/sys/devices/system/cpu", R_OK) == 0) return;
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    const long long bytes = (long long)sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
    setenv("HWLOC_SYNTHETIC", text("NUMANode:1(memory=%lld) Core:%ld PU:1", bytes, cores), 0);
    setenv("HWLOC_THISSYSTEM", "1", 0);
}

static void describe_bundle(const char* root) {
    describe_machine();
    prepend("PATH", text("%s/libexec", root)); /* PoCL calls `ld` */
    if (__builtin_cpu_supports("avx2")) /* its built-in functions are compiled for that */
        setenv("WEFT_OPENCL_DRIVERS", text("%s/lib/pocl/libpocl.so.2", root), 0);
    if (access("/etc/fonts/fonts.conf", R_OK) != 0)
        setenv("FONTCONFIG_FILE", text("%s/share/fonts/fonts.conf", root), 0);
}

/* What every call of the linker gets beyond its own arguments: the C library to link against. */
static char** arguments_of(const char* name, const char* root, int count, char** given) {
    char** all = calloc((size_t)count + 8, sizeof(char*));
    if (!all) fail("out of memory");
    memcpy(all, given, (size_t)count * sizeof(char*));
    if (strcmp(name, "ld") == 0) all[count] = text("-L%s/lib/link", root);
    return all;
}

static void start(const char* root, const char* program, char** arguments) {
    char* own_cxx = text("%s/lib/gcc", root);
    const int has_libc = host_glibc_minor() >= BUNDLED_GLIBC_MINOR;
    if (has_libc) {
        if (host_cxx_library_minor() < cxx_library_minor(own_cxx))
            prepend("LD_LIBRARY_PATH", own_cxx);
        execv(program, arguments);
        fail(program);
    }
    char* loader = text("%s/lib/glibc/ld-linux-x86-64.so.2", root);
    char* libraries = text("%s/lib:%s/lib/glibc:%s", root, root, own_cxx);
    char* head[] = {loader, (char*)"--argv0", arguments[0], (char*)"--library-path", libraries,
                    (char*)program};
    const size_t heads = sizeof(head) / sizeof(*head);
    size_t count = 1;
    while (arguments[count]) ++count;
    char** all = calloc(heads + count, sizeof(char*));
    if (!all) fail("out of memory");
    memcpy(all, head, sizeof(head));
    memcpy(all + heads, arguments + 1, (count - 1) * sizeof(char*));
    execv(loader, all);
    fail(loader);
}

int main(int argc, char** argv) {
    char* self = own_path();
    char* name = basename(text("%s", self));
    char* root = dirname(dirname(text("%s", self)));
    if (strcmp(name, "ld") != 0) describe_bundle(root);
    start(root, text("%s/libexec/%s.bin", root, name), arguments_of(name, root, argc, argv));
}
