#pragma once
/// Writes files of VTK's XML format, which ParaView reads. Numbers are compressed by zlib and written as Base64 within
/// their elements, so that the files are XML for any reader.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace flexarm::pictures {

// ---------------------------------------------------------------- arrays

/// An array with a name, as an element of XML.
/// @param values           `components` numbers for each point or cell
/// @param component_names  as ParaView shows them; none: x, y, z
template <class Number>
std::string vtk_array(const std::string& name, const std::vector<Number>& values, int components = 1,
                      const std::vector<std::string>& component_names = {});
/// An array of texts, which may contain anything but a zero.
std::string vtk_array(const std::string& name, const std::vector<std::string>& texts);

// ---------------------------------------------------------------- one instant

/// Cells of one kind: the points of all cells one after the other, and where those of each cell end.
struct VtkCells {
  std::vector<std::int64_t> points, ends;
};

/// Points, and cells between them. Cells are numbered in this order: vertices, lines, polygons.
struct VtkPolyData {
  std::size_t point_count = 0;
  std::string points;                     ///< vtk_array() of positions
  std::string vertices, lines, polygons;  ///< of vtk_cells()
  std::size_t vertex_count = 0, line_count = 0, polygon_count = 0;
  std::vector<std::string> field_data, point_data, cell_data;  ///< of vtk_array()
  /// What arrays in point_data are to VTK, as attributes of XML: `Scalars="NAME"`, by which ParaView colours the points
  /// at first, or `Normals="NAME"`.
  std::string roles;
};

/// Cells as the content of an element.
std::string vtk_cells(const VtkCells& cells);
/// A file of the kind .vtp.
std::string vtk_text(const VtkPolyData& data, double time);

// ---------------------------------------------------------------- the series

/// Writes a text as a file. @throws std::runtime_error naming the file and the reason
void write_vtk_file(const std::filesystem::path& path, const std::string& text);

/// A file of the kind .pvd, which lists files by their times.
class VtkCollection {
 public:
  struct Part {
    std::string name, file;  ///< relative to the folder of this one
  };

  explicit VtkCollection(std::filesystem::path path) : path_(std::move(path)) {}
  void add(double time, const std::vector<Part>& parts);
  /// Replaces the file by the present list, as a whole. @throws std::runtime_error naming the file and the reason
  void write() const;

 private:
  std::filesystem::path path_;
  std::string lines_;
};

}  // namespace flexarm::pictures
