#pragma once
/// Results of a simulation as an HDF5 file.

#include <future>
#include <string>
#include <vector>

#include <hdf5.h>

#include "flexarm/simulation/result_writer.h"
#include "recording/replaced_file.h"

namespace flexarm::recording {

/// A data set for each column, of its name ("/joint/shoulder/position"), with the attributes `name` and `unit`; of
/// double numbers, compressed without loss, in a thread of its own while the simulation goes on. The file has the
/// attributes `robot`, `scheme` and `step`. What was at its place before stays there until close().
class Hdf5Writer : public ResultWriter {
 public:
  /// @throws std::runtime_error naming the file if it cannot be written; so do the other functions
  Hdf5Writer(const std::string& path, const Simulation& simulation, ResultColumns columns);

  void write_row(const Simulation& simulation) override;
  void close() override;

 private:
  /// An identifier of the library, with what ends it.
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
  std::vector<double> rows_, outgoing_;  // rows to come, and those that are being written
  std::vector<double> column_;           // one column of the latter
  hsize_t written_ = 0;                  // rows
  std::future<void> writing_;            // the last member: what it uses outlives it
};

}  // namespace flexarm::recording
