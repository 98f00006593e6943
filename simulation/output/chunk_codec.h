#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "runtime/io/compression.h"

struct libdeflate_compressor;

namespace weft {

/// Makes of float32 values (little-endian) what HDF5's filters `shuffle` and `deflate` decode, in a
/// tenth of the time that they would take to encode it. Without compression: the values as they
/// are.
class ChunkCodec {
public:
    explicit ChunkCodec(Compression compression);

    /// Valid until the next call.
    std::span<const std::byte> encode(std::span<const float> values);

private:
    struct Closer {
        void operator()(libdeflate_compressor* compressor) const;
    };

    Compression compression_;
    std::unique_ptr<libdeflate_compressor, Closer> compressor_;  ///< null: no compression
    std::vector<std::byte> shuffled_, encoded_;
};

/// The level that a file notes for its deflate filter; readers do not need it. 0: no filters.
int deflate_level(Compression compression);

}  // namespace weft
