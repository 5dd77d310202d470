#include "pictures/vtk_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "pictures/tracks.h"
#include "simulation/unfinished_file.h"

namespace flexarm::pictures {
namespace {

namespace fs = std::filesystem;

/// Numbers are written as they are in memory.
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
constexpr const char* kByteOrder = "LittleEndian";
#else
constexpr const char* kByteOrder = "BigEndian";
#endif

template <class Number>
std::string vtk_type() {
  const char* kind = std::is_floating_point_v<Number> ? "Float" : std::is_signed_v<Number> ? "Int" : "UInt";
  return fmt::format("{}{}", kind, 8 * sizeof(Number));
}

template <class Number>
std::string_view bytes_of(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

/// Bytes as the compressor vtkZLibDataCompressor writes them, as one block: number of blocks, size of a block, size of
/// the last block if it is not full, compressed size of each block, and, encoded separately, the blocks.
std::string encoded(std::string_view bytes) {
  if (bytes.empty()) return base64(bytes_of(std::vector<std::uint64_t>{0, 1, 0}));
  const std::string block = deflated(bytes);
  return base64(bytes_of(std::vector<std::uint64_t>{1, bytes.size(), 0, block.size()})) + base64(block);
}

std::string vtk_element(const std::string& tag, const std::string& content) {
  return "<" + tag + ">\n" + content + "</" + tag + ">\n";
}

std::string vtk_joined(const std::vector<std::string>& elements) {
  std::string out;
  for (const std::string& element : elements) out += element;
  return out;
}

}  // namespace

// ---------------------------------------------------------------- arrays

template <class Number>
std::string vtk_array(const std::string& name, const std::vector<Number>& values, int components,
                      const std::vector<std::string>& component_names) {
  std::string names;
  for (std::size_t i = 0; i < component_names.size(); ++i)
    names += fmt::format(" ComponentName{}=\"{}\"", i, component_names[i]);
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} NumberOfTuples=\"{}\" format=\"binary\">{}"
      "</DataArray>\n",
      vtk_type<Number>(), name, components, names, values.size() / static_cast<std::size_t>(components),
      encoded(bytes_of(values)));
}

#define FLEXARM_VTK_ARRAY(Number)                                                             \
  template std::string vtk_array<Number>(const std::string&, const std::vector<Number>&, int, \
                                         const std::vector<std::string>&)
FLEXARM_VTK_ARRAY(double);
FLEXARM_VTK_ARRAY(float);
FLEXARM_VTK_ARRAY(std::int32_t);
FLEXARM_VTK_ARRAY(std::int64_t);
FLEXARM_VTK_ARRAY(std::uint8_t);
#undef FLEXARM_VTK_ARRAY

std::string vtk_array(const std::string& name, const std::vector<std::string>& texts) {
  std::string bytes;
  for (const std::string& text : texts) bytes += text + '\0';
  return fmt::format("<Array type=\"String\" Name=\"{}\" NumberOfTuples=\"{}\" format=\"binary\">{}</Array>\n", name,
                     texts.size(), encoded(bytes));
}

// ---------------------------------------------------------------- one instant

std::string vtk_cells(const VtkCells& cells) {
  return vtk_array("connectivity", cells.points) + vtk_array("offsets", cells.ends);
}

std::string vtk_text(const VtkPolyData& data, double time) {
  const auto fields = vtk_joined(data.field_data) + vtk_array("TimeValue", std::vector<double>{time});
  std::string piece = "<PointData " + data.roles + ">\n" + vtk_joined(data.point_data) + "</PointData>\n" +
                      vtk_element("CellData", vtk_joined(data.cell_data)) + vtk_element("Points", data.points);
  for (const auto& [tag, cells] :
       {std::pair("Verts", &data.vertices), {"Lines", &data.lines}, {"Polys", &data.polygons}})
    if (!cells->empty()) piece += vtk_element(tag, *cells);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n{}"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n{}</Piece>\n</PolyData>\n</VTKFile>\n",
      kByteOrder, vtk_element("FieldData", fields), data.point_count, data.vertex_count, data.line_count,
      data.polygon_count, piece);
}

// ---------------------------------------------------------------- the series

void write_vtk_file(const fs::path& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write '" + path.string() + "': " + std::strerror(errno));
}

void VtkCollection::add(double time, const std::vector<Part>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    lines_ += fmt::format("<DataSet timestep=\"{:.17g}\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", time, i,
                          parts[i].name, parts[i].file);
}

void VtkCollection::write() const {
  const std::string head = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"{}\">\n", kByteOrder);
  try {
    UnfinishedFile(path_.string(), head + vtk_element("Collection", lines_) + "</VTKFile>\n").put_in_place();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("'" + path_.string() + "' " + error.what());
  }
}

}  // namespace flexarm::pictures
