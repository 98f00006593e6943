#include "simulation/mesh/mesh_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "runtime/error.h"

namespace weft {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 25> kFormats{{
    {".obj", "OBJ"},       {".msh", "Gmsh"},    {".vtk", "legacy VTK"}, {".vtu", "VTK XML"},
    {".vtp", "VTK XML"},   {".ply", "PLY"},     {".stl", "STL"},        {".off", "OFF"},
    {".gltf", "glTF"},     {".glb", "glTF"},    {".fbx", "FBX"},        {".dae", "Collada"},
    {".abc", "Alembic"},   {".usd", "USD"},     {".usda", "USD"},       {".usdc", "USD"},
    {".usdz", "USD"},      {".3ds", "3DS"},     {".blend", "Blender"},  {".zprj", "CLO"},
    {".zpac", "CLO"},      {".node", "TetGen"}, {".h5", "HDF5"},        {".hdf5", "HDF5"},
    {".vtkhdf", "VTKHDF"},
}};

}  // namespace

std::string mesh_format(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const auto& [known, name] : kFormats) {
        if (ending == known) return name;
    }
    return "";
}

std::string other_format(const std::string& path) {
    const std::string format = mesh_format(path);
    return format.empty() ? "" : fmt::format("{} is not read here: ", format);
}

void require_obj(const std::string& path) {
    if (mesh_format(path) == "OBJ") return;
    throw UserError(
        fmt::format("{}: {}a cloth's mesh must be a Wavefront OBJ (.obj) file; export "
                    "it as one",
                    path, other_format(path)));
}

}  // namespace weft
