#pragma once

/// The one list of element families, in the order in which solvers, traces and reports have them:
/// the order of projections follows it, and so the result. A name x stands for
///   simulation/families/x/               make_x_builder(): what the simulation asks of it
///   simulation/scene/elements/x.cpp      x_keys(): how a scene describes it
///   kernels/{energies,xpbd,descent,sosd}/x.h
// clang-format off
#define WEFT_ELEMENT_FAMILIES(family) \
    family(springs)                   \
    family(membranes)                 \
    family(tetrahedra)                \
    family(hinges)                    \
    family(curved_hinges)             \
    family(woven)                     \
    family(stitches)
// clang-format on
