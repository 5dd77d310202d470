#pragma once
/// Writes results of a simulation as an HDF5 file.

#include <future>
#include <string>
#include <vector>

#include <hdf5.h>

#include "flexarm/simulation/result_writer.h"
#include "recording/replaced_file.h"
#include "recording/scene_origin.h"

namespace flexarm::recording {

/// Writes a data set for each column, with the column's name as its path ("/joint/shoulder/position") and the
/// attributes `name` and `unit`. Data are doubles, compressed without loss by a separate thread while the simulation
/// continues. The file has the attributes `robot`, `scheme`, `step`, `scene` and `scene_options` (SceneOrigin). An
/// older file at the same path stays until close().
class Hdf5Writer : public ResultWriter {
 public:
  /// @throws std::runtime_error naming the file if it cannot be written. The other functions do the same.
  Hdf5Writer(const std::string& path, const Simulation& simulation, ResultColumns columns, const SceneOrigin& origin);

  void write_row(const Simulation& simulation) override;
  void close() override;

 private:
  /// Owns an identifier of HDF5, with the function that closes it.
  class Handle {
   public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = H5I_INVALID_HID; }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() { close(); }
    hid_t id() const { return id_; }
    bool close();

   private:
    hid_t id_;
    herr_t (*close_)(hid_t);
  };

  hid_t checked(hid_t id) const;
  void check(herr_t status) const;
  void add_text(hid_t object, const char* name, const std::string& text) const;
  void add_data_set(const ResultColumn& column);
  void begin_writing();
  void end_writing();
  void write(const std::vector<double>& rows);

  ReplacedFile place_;
  ResultColumns columns_;
  Handle file_;
  std::vector<Handle> data_sets_;        // per column
  std::vector<double> rows_, outgoing_;  // rows for the next task; rows that the present task writes
  std::vector<double> column_;           // scratch memory of the task: one column of outgoing_
  hsize_t written_ = 0;                  // number of rows in the file
  std::future<void> writing_;            // must be the last member, so that all others outlive the task
};

}  // namespace flexarm::recording
