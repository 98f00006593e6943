#include "simulation/output/checkpoint.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "runtime/error.h"
#include "runtime/io/whole_file.h"
#include "simulation/output/any_checkpoint.h"

namespace weft {

namespace {

// Text lines: format, origin as JSON, frame, substeps, iterations and what is known of the
// tolerance, the account's bits, sizes of the report and the buffers; then their bytes, then kEnd.
constexpr const char* kFormat = "weft-checkpoint 8";
constexpr const char* kEnd = "end";

template <class Bytes>
std::string_view text_of(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <class Bytes>
void read_bytes(std::istream& in, Bytes& bytes) {
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::string line_of(const TextPairs& origin) {
    return nlohmann::json(origin).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<std::string> texts_of(const TextPairs& origin, const std::string& name) {
    std::vector<std::string> texts;
    for (const auto& [own_name, text] : origin) {
        if (own_name == name) texts.push_back(text);
    }
    return texts;
}

/// The names of what two origins that are not the same differ in.
std::string differences(const TextPairs& then, const TextPairs& now) {
    std::vector<std::string> names;
    for (const TextPairs* origin : {&now, &then}) {
        for (const auto& [name, text] : *origin) {
            if (texts_of(then, name) == texts_of(now, name)) continue;
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
        }
    }
    return names.empty() ? "the order of what is set" : fmt::format("{}", fmt::join(names, ", "));
}

std::string differences(const std::string& then, const TextPairs& now) {
    try {
        return differences(nlohmann::json::parse(then).get<TextPairs>(), now);
    } catch (const nlohmann::json::exception&) {
        return "version of weft";  // an earlier one wrote no names
    }
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const TextPairs& origin,
                      const Checkpoint& checkpoint) {
    std::string head = std::string(kFormat) + '\n' + line_of(origin) + '\n';
    for (const int number : {checkpoint.frame, checkpoint.substeps, checkpoint.iterations,
                             checkpoint.failed_iterations, checkpoint.tolerance_told}) {
        head += std::to_string(number) + ' ';
    }
    head += '\n';
    for (const double value : checkpoint.account) {
        head += std::to_string(std::bit_cast<std::uint64_t>(value)) + ' ';
    }
    head += '\n' + std::to_string(checkpoint.report.size());
    head += ' ' + std::to_string(checkpoint.buffers.size());
    for (const auto& buffer : checkpoint.buffers) head += ' ' + std::to_string(buffer.size());

    WholeFile file(path, " the checkpoint");
    file.write(head + '\n');
    file.write(text_of(checkpoint.report));
    for (const auto& buffer : checkpoint.buffers) file.write(text_of(buffer));
    file.write(kEnd);
    file.finish();
}

namespace {

/// origin: null: any
std::optional<Checkpoint> read(const std::filesystem::path& path, const TextPairs* origin,
                               const std::string& advice) {
    std::ifstream in(path, std::ios::binary);
    if (!in) return std::nullopt;
    const auto damaged = [&] {
        return UserError(path.string() + ": the checkpoint cannot be read" + advice);
    };
    std::string format, made_from, end(std::strlen(kEnd), ' ');
    std::getline(in, format);
    std::getline(in, made_from);
    if (format != kFormat) throw damaged();
    if (origin != nullptr && made_from != line_of(*origin)) {
        throw UserError(
            fmt::format("{}: the run there differs from this one in: {}; --force starts it anew, "
                        "another --out keeps it",
                        path.string(), differences(made_from, *origin)));
    }
    const std::uintmax_t file_size = std::filesystem::file_size(path);
    std::uintmax_t sum = 0;
    const auto read_size = [&] {
        std::uintmax_t size = 0;
        in >> size;
        sum += size;
        if (!in || size > file_size || sum > file_size) throw damaged();
        return size;
    };
    Checkpoint checkpoint;
    in >> checkpoint.frame >> checkpoint.substeps >> checkpoint.iterations >>
        checkpoint.failed_iterations >> checkpoint.tolerance_told;
    for (double& value : checkpoint.account) {
        std::uint64_t bits = 0;
        in >> bits;
        value = std::bit_cast<double>(bits);
    }
    if (!in || checkpoint.frame < 0 || checkpoint.substeps < 1 || checkpoint.iterations < 1) {
        throw damaged();
    }
    checkpoint.report.resize(read_size());
    const std::uintmax_t count = read_size();
    for (std::uintmax_t b = 0; b < count; ++b) checkpoint.buffers.emplace_back(read_size());
    in.get();  // the line's end
    read_bytes(in, checkpoint.report);
    for (auto& buffer : checkpoint.buffers) read_bytes(in, buffer);
    in.read(end.data(), static_cast<std::streamsize>(end.size()));
    if (!in || end != kEnd) throw damaged();
    return checkpoint;
}

}  // namespace

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& path,
                                          const TextPairs& origin) {
    return read(path, &origin, "; --force starts the run anew");
}

Checkpoint read_any_checkpoint(const std::filesystem::path& path) {
    auto checkpoint = read(path, nullptr, "");
    if (!checkpoint) throw UserError(path.string() + ": no such checkpoint");
    return std::move(*checkpoint);
}

TextPairs settings_of(const Checkpoint& checkpoint, const std::filesystem::path& path) {
    try {
        return nlohmann::json::from_cbor(checkpoint.report).at("settings").get<TextPairs>();
    } catch (const nlohmann::json::exception&) {
        throw UserError(path.string() + ": the checkpoint does not say what run it is of");
    }
}

}  // namespace weft
