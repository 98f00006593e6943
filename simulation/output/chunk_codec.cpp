#include "simulation/output/chunk_codec.h"

#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <stdexcept>

namespace weft {

namespace {

using Bytes = std::span<const std::byte>;

/// All first bytes, then all second ones, ...: equal bytes side by side compress better.
void shuffle(std::span<const float> values, std::vector<std::byte>& to) {
    const auto* from = reinterpret_cast<const std::byte*>(values.data());
    const std::size_t count = values.size();
    to.resize(count * sizeof(float));
    for (std::size_t byte = 0; byte < sizeof(float); ++byte) {
        std::byte* plane = to.data() + byte * count;
        for (std::size_t i = 0; i < count; ++i) plane[i] = from[i * sizeof(float) + byte];
    }
}

void put(std::vector<std::byte>& to, std::initializer_list<std::uint32_t> bytes) {
    for (const std::uint32_t byte : bytes) to.push_back(static_cast<std::byte>(byte & 0xffU));
}

/// Blocks of deflate that are not compressed (RFC 1951, 3.2.4), none of them the last.
void put_stored(std::vector<std::byte>& to, Bytes bytes) {
    constexpr std::size_t kLongest = 0xffff;
    while (!bytes.empty()) {
        const Bytes block = bytes.first(std::min(bytes.size(), kLongest));
        const auto length = static_cast<std::uint32_t>(block.size());
        put(to, {0, length, length >> 8U, ~length, ~length >> 8U});
        to.insert(to.end(), block.begin(), block.end());
        bytes = bytes.subspan(block.size());
    }
}

/// The rest of the stream, compressed.
void put_deflated(std::vector<std::byte>& to, Bytes bytes, libdeflate_compressor* compressor) {
    const std::size_t begin = to.size();
    to.resize(begin + libdeflate_deflate_compress_bound(compressor, bytes.size()));
    const std::size_t size = libdeflate_deflate_compress(compressor, bytes.data(), bytes.size(),
                                                         to.data() + begin, to.size() - begin);
    if (size == 0) throw std::logic_error("libdeflate needs more than it says");
    to.resize(begin + size);
}

}  // namespace

int deflate_level(Compression compression) {
    switch (compression) {
        case Compression::kNone:
            return 0;
        case Compression::kFast:
            return 1;
        case Compression::kSmall:
            return 6;
    }
    return 0;
}

void ChunkCodec::Closer::operator()(libdeflate_compressor* compressor) const {
    libdeflate_free_compressor(compressor);
}

ChunkCodec::ChunkCodec(Compression compression) : compression_(compression) {
    if (compression == Compression::kNone) return;
    compressor_.reset(libdeflate_alloc_compressor(deflate_level(compression)));
    if (!compressor_) throw std::bad_alloc();
}

/// The low halves of positions are noise: stored as they are, they cost 4 % of the size and save
/// two thirds of the time. The frame around all of it is that of zlib (RFC 1950).
Bytes ChunkCodec::encode(std::span<const float> values) {
    if (!compressor_) return std::as_bytes(values);
    shuffle(values, shuffled_);
    const Bytes bytes(shuffled_);
    const std::size_t stored = compression_ == Compression::kFast ? bytes.size() / 2 : 0;
    encoded_.clear();
    put(encoded_, {0x78, 0x01});
    put_stored(encoded_, bytes.first(stored));
    put_deflated(encoded_, bytes.subspan(stored), compressor_.get());
    const std::uint32_t sum = libdeflate_adler32(1, bytes.data(), bytes.size());
    put(encoded_, {sum >> 24U, sum >> 16U, sum >> 8U, sum});
    return encoded_;
}

}  // namespace weft
