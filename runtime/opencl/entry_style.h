#pragma once

namespace weft {

/// How kernels are turned into entry points of an OpenCL device.
enum class EntryStyle {
    kPerStrip,   ///< one work-item runs a task's whole body on one strip: for CPU devices
    kPerGroup,   ///< a work-group does, with a barrier behind each colour: for GPUs
    kPerColour,  ///< one work-item per item, one launch per kernel and colour: for GPUs, where a
                 ///< body has more parameters than an entry point may have
};

}  // namespace weft
