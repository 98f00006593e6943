#include "simulation/output/checkpoint.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "runtime/error.h"

namespace weft {

namespace {

// Text lines: format, origin, frame, sizes of the buffers; then their bytes, then kEnd.
constexpr const char* kFormat = "weft-checkpoint 1";
constexpr const char* kEnd = "end";

}  // namespace

std::filesystem::path unfinished_checkpoint(const std::filesystem::path& path) {
    return path.string() + ".part";
}

void write_checkpoint(const std::filesystem::path& path, const std::string& origin,
                      const Checkpoint& checkpoint) {
    const std::filesystem::path part = unfinished_checkpoint(path);
    errno = 0;
    {
        std::ofstream out(part, std::ios::binary);
        out << kFormat << '\n' << origin << '\n' << checkpoint.frame;
        out << '\n' << checkpoint.buffers.size();
        for (const auto& buffer : checkpoint.buffers) out << ' ' << buffer.size();
        out << '\n';
        for (const auto& buffer : checkpoint.buffers) {
            out.write(reinterpret_cast<const char*>(buffer.data()),
                      static_cast<std::streamsize>(buffer.size()));
        }
        out << kEnd << std::flush;
        if (out && std::rename(part.c_str(), path.c_str()) == 0) return;
    }
    const std::string reason = errno != 0 ? std::strerror(errno) : "write failed";
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw RunError(path.string() + ": cannot write the checkpoint: " + reason);
}

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& path,
                                          const std::string& origin) {
    std::ifstream in(path, std::ios::binary);
    if (!in) return std::nullopt;
    const auto damaged = [&] {
        return UserError(path.string() +
                         ": the checkpoint cannot be read; --force starts the run anew");
    };
    std::string format, made_from, end(std::strlen(kEnd), ' ');
    std::getline(in, format);
    std::getline(in, made_from);
    if (format != kFormat) throw damaged();
    if (made_from != origin) {
        throw UserError(path.string() +
                        ": the run there was made from another scene, mesh, setting or version of "
                        "weft; --force starts it anew");
    }
    const std::uintmax_t file_size = std::filesystem::file_size(path);
    Checkpoint checkpoint;
    std::size_t count = 0;
    in >> checkpoint.frame >> count;
    if (!in || checkpoint.frame < 0 || count > 1000) throw damaged();
    std::uintmax_t sum = 0;
    for (std::size_t b = 0; b < count; ++b) {
        std::uintmax_t size = 0;
        in >> size;
        sum += size;
        if (!in || size > file_size || sum > file_size) throw damaged();
        checkpoint.buffers.emplace_back(size);
    }
    in.get();  // the line's end
    for (auto& buffer : checkpoint.buffers) {
        in.read(reinterpret_cast<char*>(buffer.data()),
                static_cast<std::streamsize>(buffer.size()));
    }
    in.read(end.data(), static_cast<std::streamsize>(end.size()));
    if (!in || end != kEnd) throw damaged();
    return checkpoint;
}

}  // namespace weft
