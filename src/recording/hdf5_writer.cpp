#include "recording/hdf5_writer.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include "flexarm/scene/scene_description.h"

namespace flexarm::recording {
namespace {

/// Number of rows that are compressed together.
constexpr hsize_t kChunk = 1024;
/// Level of deflate. Higher levels take longer and gain little for such numbers.
constexpr unsigned kCompression = 1;

}  // namespace

bool Hdf5Writer::Handle::close() {
  const hid_t id = std::exchange(id_, H5I_INVALID_HID);
  return id < 0 || close_(id) >= 0;
}

hid_t Hdf5Writer::checked(hid_t id) const {
  if (id < 0) place_.fail(errno != 0 ? std::strerror(errno) : "HDF5 refuses it");
  return id;
}

void Hdf5Writer::check(herr_t status) const {
  checked(status);
}

Hdf5Writer::Hdf5Writer(const std::string& path, const Simulation& simulation, ResultColumns columns,
                       const SceneOrigin& origin)
    : place_(path),
      columns_(std::move(columns)),
      // Prevents HDF5 from printing errors.
      file_((H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr), errno = 0,
             checked(H5Fcreate(place_.unfinished().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT))),
            H5Fclose),
      column_(kChunk) {
  add_text(file_.id(), "robot", simulation.scene().name);
  add_text(file_.id(), "scheme", simulation.scheme());
  add_text(file_.id(), "scene", origin.path);
  add_text(file_.id(), "scene_options", origin.options);
  const Handle scalar(checked(H5Screate(H5S_SCALAR)), H5Sclose);
  const Handle step(checked(H5Acreate2(file_.id(), "step", H5T_NATIVE_DOUBLE, scalar.id(), H5P_DEFAULT, H5P_DEFAULT)),
                    H5Aclose);
  const double size = simulation.step_size();
  check(H5Awrite(step.id(), H5T_NATIVE_DOUBLE, &size));
  for (const ResultColumn& column : columns_.columns()) add_data_set(column);
  // Puts names and attributes at the file's begin, so that a file whose end is lost can be read up to there.
  check(H5Fflush(file_.id(), H5F_SCOPE_LOCAL));
  for (std::vector<double>* rows : {&rows_, &outgoing_}) rows->reserve(kChunk * columns_.columns().size());
}

void Hdf5Writer::add_text(hid_t object, const char* name, const std::string& text) const {
  const Handle type(checked(H5Tcopy(H5T_C_S1)), H5Tclose);
  check(H5Tset_size(type.id(), H5T_VARIABLE));
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8));
  const Handle scalar(checked(H5Screate(H5S_SCALAR)), H5Sclose);
  const Handle attribute(checked(H5Acreate2(object, name, type.id(), scalar.id(), H5P_DEFAULT, H5P_DEFAULT)), H5Aclose);
  const char* value = text.c_str();
  check(H5Awrite(attribute.id(), type.id(), &value));
}

void Hdf5Writer::add_data_set(const ResultColumn& column) {
  const hsize_t none = 0, unlimited = H5S_UNLIMITED;
  const Handle space(checked(H5Screate_simple(1, &none, &unlimited)), H5Sclose);
  const Handle storage(checked(H5Pcreate(H5P_DATASET_CREATE)), H5Pclose);
  check(H5Pset_chunk(storage.id(), 1, &kChunk));
  check(H5Pset_shuffle(storage.id()));
  check(H5Pset_deflate(storage.id(), kCompression));
  // Whole chunks are written, which need no cache: one would keep them until the end.
  const Handle access(checked(H5Pcreate(H5P_DATASET_ACCESS)), H5Pclose);
  check(H5Pset_chunk_cache(access.id(), 0, 0, 1));
  const Handle link(checked(H5Pcreate(H5P_LINK_CREATE)), H5Pclose);
  check(H5Pset_create_intermediate_group(link.id(), 1));
  check(H5Pset_char_encoding(link.id(), H5T_CSET_UTF8));
  data_sets_.emplace_back(checked(H5Dcreate2(file_.id(), column.name.c_str(), H5T_IEEE_F64LE, space.id(), link.id(),
                                             storage.id(), access.id())),
                          H5Dclose);
  add_text(data_sets_.back().id(), "name", column.name);
  add_text(data_sets_.back().id(), "unit", column.unit);
}

void Hdf5Writer::write_row(const Simulation& simulation) {
  const std::vector<double>& row = columns_.row(simulation, take_counts());
  rows_.insert(rows_.end(), row.begin(), row.end());
  if (rows_.size() == kChunk * row.size()) begin_writing();
}

/// HDF5 must be used by one thread at a time. So nothing but the task uses it until end_writing().
void Hdf5Writer::begin_writing() {
  end_writing();
  std::swap(rows_, outgoing_);
  rows_.clear();
  writing_ = std::async(std::launch::async, [this] { write(outgoing_); });
}

void Hdf5Writer::end_writing() {
  if (writing_.valid()) writing_.get();
}

void Hdf5Writer::write(const std::vector<double>& rows) {
  errno = 0;
  const std::size_t width = data_sets_.size();
  const hsize_t count = rows.size() / width, total = written_ + count;
  if (count == 0) return;
  const Handle memory(checked(H5Screate_simple(1, &count, nullptr)), H5Sclose);
  for (std::size_t k = 0; k < width; ++k) {
    for (hsize_t i = 0; i < count; ++i) column_[i] = rows[i * width + k];
    check(H5Dset_extent(data_sets_[k].id(), &total));
    const Handle space(checked(H5Dget_space(data_sets_[k].id())), H5Sclose);
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &written_, nullptr, &count, nullptr));
    check(H5Dwrite(data_sets_[k].id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, column_.data()));
  }
  written_ = total;
}

void Hdf5Writer::close() {
  end_writing();
  write(rows_);
  bool is_closed = true;
  for (Handle& data_set : data_sets_) is_closed = data_set.close() && is_closed;
  is_closed = file_.close() && is_closed;
  if (!is_closed) place_.fail(errno != 0 ? std::strerror(errno) : "HDF5 cannot end it");
  place_.put_in_place();
}

}  // namespace flexarm::recording
