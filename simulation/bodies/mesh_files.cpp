#include "simulation/bodies/mesh_files.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "runtime/error.h"
#include "runtime/io/word_hash.h"
#include "simulation/bodies/frame_files.h"

namespace weft {

std::vector<BodyMesh> mesh_files(const Scene& scene) {
    std::vector<BodyMesh> list;
    const auto add = [&](const std::string& body, const Shape& shape) {
        const auto* file = std::get_if<MeshFile>(&shape);
        if (file == nullptr) return;
        list.push_back({body, file->path, {file->path}});
        if (!file->rest.empty()) list.push_back({body + ".rest", file->rest, {file->rest}});
    };
    for (const Cloth& cloth : scene.cloths) add("cloth." + cloth.name, cloth.shape);
    for (const Solid& solid : scene.solids) add("solid." + solid.name, solid.shape);
    for (const MeshObstacle& obstacle : scene.mesh_obstacles) {
        add("obstacle." + obstacle.name, obstacle.shape);
        if (obstacle.frames.empty()) continue;
        list.push_back(
            {"obstacle." + obstacle.name + ".frames", obstacle.frames, frame_files(obstacle)});
    }
    return list;
}

void check_there(const MeshFile& file) {
    for (const std::string& path : {file.path, file.rest}) {
        std::error_code ignored;
        if (path.empty() || std::filesystem::exists(path, ignored)) continue;
        const std::string where = file.where.empty() ? "" : file.where + ": ";
        throw UserError(where + path + ": no such mesh file");
    }
}

std::string file_hash(const std::string& path) {
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    WordHash hash;
    std::uint32_t length = 0;
    std::array<char, 1 << 16> block;
    while (stream) {
        block.fill('\0');  // the last word of the file is filled up with zeros
        stream.read(block.data(), block.size());
        const auto count = static_cast<std::size_t>(stream.gcount());
        for (std::size_t i = 0; i < count; i += sizeof(std::uint32_t)) {
            std::uint32_t word = 0;
            std::memcpy(&word, block.data() + i, sizeof(word));
            hash.add(word);
        }
        length += static_cast<std::uint32_t>(count);
    }
    hash.add(length);
    if (!stream.eof()) throw UserError(path + ": " + std::strerror(errno != 0 ? errno : EIO));
    return hash.text();
}

std::string mesh_hash(const BodyMesh& mesh) {
    if (mesh.files.size() == 1) return file_hash(mesh.files.front());
    WordHash hash;
    for (const std::string& path : mesh.files) {
        for (const char digit : file_hash(path)) hash.add(static_cast<unsigned char>(digit));
    }
    return hash.text();
}

}  // namespace weft
