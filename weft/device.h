#pragma once

// Devices: those of the machine, and one's own.
//
//   auto devices = weft::open_devices("cpu/1+opencl:0/1");   // or "hybrid", "gpu", ...
//   devices[0]->info().name;
//
// A device of one's own, for tests or for hardware that Weft does not know, is a weft::Device whose
// DeviceStream does what is submitted; weft::run_on_host() does a task's work for it by the scalar
// kernels. Runner takes any mixture of both. Times are seconds, sizes elements or bytes as named.

#include "runtime/device.h"
#include "runtime/device_list.h"
