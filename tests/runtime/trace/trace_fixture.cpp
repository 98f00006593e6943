// Writes a made-up trace for tests: trace_fixture PATH FRAMES [PAUSE_MS]
// With a pause it is a running simulation: it prints a line per frame, then waits that long.

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "runtime/trace/trace_writer.h"
#include "tests/runtime/trace/synthetic_run.h"

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    const weft::synthetic::Shape shape;
    const auto frames = static_cast<std::uint32_t>(std::atoi(argv[2]));
    const int pause = argc > 3 ? std::atoi(argv[3]) : 0;

    weft::TraceWriter writer(argv[1], weft::synthetic::describe(shape));
    for (std::uint32_t i = 0; i < frames; ++i) {
        writer.append(weft::synthetic::frame(shape, i));
        if (pause == 0) continue;
        std::cout << i << std::endl;
        std::this_thread::sleep_for(std::chrono::milliseconds(pause));
    }
    writer.finish("00112233445566778899aabbccddeeff");
}
