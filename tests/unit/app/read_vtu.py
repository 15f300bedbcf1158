# SPDX-License-Identifier: BSD-3-Clause
"""Reads a .vtu file with VTK itself and prints what it found; see test_output.cpp."""
import sys

try:
    import vtk
except ImportError:
    sys.exit(77)

reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
print(grid.GetNumberOfPoints(), grid.GetNumberOfCells(), grid.GetCellType(0))
print(grid.GetFieldData().GetArray("TimeValue").GetValue(0))
for name in ("displacement", "velocity"):
    array = grid.GetPointData().GetArray(name)
    print(*(sum(array.GetComponent(i, axis) for i in range(array.GetNumberOfTuples())) for axis in range(3)))
sys.exit(reader.GetErrorCode())
