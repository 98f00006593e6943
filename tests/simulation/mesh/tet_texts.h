#pragma once

#include <string>

namespace weft::test {

/// Two tetrahedra that share a face, and a triangle that does not count, as each format has them.
inline const std::string kMsh2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
10 0 0 0
20 1 0 0
30 0 1 0
40 0 0 1
50 1 1 1.5
$EndNodes
$Elements
3
1 2 2 0 1 10 20 30
2 4 2 0 1 10 20 30 40
3 4 2 0 1 20 30 40 50
$EndElements
)";

inline const std::string kMsh4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
0 0 1 1
1 0 0 0 1 1 1 0 0
1 0 0 0 1 1 1 0 0
$EndEntities
$Nodes
2 5 10 50
2 1 1 1
10
0 0 0 0.5 0.25
3 1 0 4
20
30
40
50
1 0 0
0 1 0
0 0 1
1 1 1.5
$EndNodes
$Elements
2 3 1 12
2 1 2 1
1 10 20 30
3 1 4 2
11 10 20 30 40
12 20 30 40 50
$EndElements
)";

inline const std::string kVtk2 = R"(# vtk DataFile Version 2.0
two tetrahedra
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
0 0 0
1 0 0
0 1 0
0 0 1
1 1 1.5
CELLS 3 14
3 0 1 2
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 3
5
10
10
CELL_DATA 3
SCALARS region int 1
LOOKUP_TABLE default
0 1 2
)";

/// As VTK 9 writes it.
inline const std::string kVtk5 = R"(# vtk DataFile Version 5.1
two tetrahedra
ASCII
DATASET UNSTRUCTURED_GRID
FIELD FieldData 1
TIME 1 1 double
0.5
POINTS 5 float
0 0 0 1 0 0 0 1 0
0 0 1 1 1 1.5
METADATA
INFORMATION 1
NAME L2_NORM_RANGE LOCATION vtkDataArray
DATA 2 0 2.0

CELLS 4 11
OFFSETS vtktypeint64
0 3 7 11
CONNECTIVITY vtktypeint64
0 1 2
0 1 2 3 1 2 3 4
CELL_TYPES 3
5
10
10
)";

}  // namespace weft::test
