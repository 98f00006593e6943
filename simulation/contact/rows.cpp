#include "simulation/contact/rows.h"

namespace weft {

void ContactRows::add_reads(Step::Adding& task, int first_strip, int end_strip, int first,
                            int last) const {
    task.reads(table.counts(), first, last);
    for (Buffer<int>* corner : {&corner0, &corner1, &corner2, &corner3}) {
        task.reads(*corner, table.entries(), first_strip, end_strip);
    }
    for (Buffer<float4>* column : {&normals, &weights, &measures}) {
        task.reads(*column, table.entries(), first_strip, end_strip);
    }
    if (have_slips()) task.reads(slips, table.entries(), first_strip, end_strip);
    task.reads(touching, first_strip, end_strip).reads(meeting, first_strip, end_strip);
}

std::vector<BufferStorage*> ContactRows::buffers() const {
    std::vector<BufferStorage*> list{&table.counts(), &corner0, &corner1, &corner2,
                                     &corner3,        &normals, &weights, &measures};
    if (have_slips()) list.push_back(&slips);
    return list;
}

}  // namespace weft
