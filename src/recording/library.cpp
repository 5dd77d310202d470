#include "recording/library.h"

#include <utility>

#include "recording/bag_writer.h"
#include "recording/hdf5_writer.h"
#include "recording/mat_writer.h"

using namespace flexarm;
using namespace flexarm::recording;

namespace {

std::unique_ptr<ResultWriter> make_hdf5(const std::string& path, const Simulation& simulation, ResultColumns columns,
                                        const SceneOrigin& origin) {
  return std::make_unique<Hdf5Writer>(path, simulation, std::move(columns), origin);
}

std::unique_ptr<ResultWriter> make_bag(const std::string& path, const Simulation& simulation,
                                       const SceneOrigin& origin) {
  return std::make_unique<BagWriter>(path, simulation, origin);
}

}  // namespace

extern "C" const Library flexarm_recording_library;
const Library flexarm_recording_library = {make_hdf5, make_bag, write_mat, replay};
