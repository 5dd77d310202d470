#include <pybind11/stl.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/names.h"

namespace py = pybind11;

namespace flexarm::python {

/// A BeamPoint in the layout of a row of a structured numpy array.
struct BeamRow {
  double arc_length, pose[kPose], strain[6], resultant[6];
};

namespace {

BeamRow row_of(const BeamPoint& point) {
  BeamRow row;
  row.arc_length = point.arc_length;
  put(point.pose, row.pose);
  std::copy_n(point.strain.data(), point.strain.size(), row.strain);
  std::copy_n(point.resultant.data(), point.resultant.size(), row.resultant);
  return row;
}

py::array_t<BeamRow> beam_points(GuardedSimulation& guarded, const Key& link, int between) {
  if (between < 0) throw std::invalid_argument("between: expected a number >= 0, got " + std::to_string(between));
  const Simulation& simulation = guarded.use();
  std::vector<BeamPoint> points;
  simulation.beam_points(link_index(simulation, link), between, points);
  py::array_t<BeamRow> rows(static_cast<py::ssize_t>(points.size()));
  std::transform(points.begin(), points.end(), rows.mutable_data(), row_of);
  return rows;
}

py::array_t<BeamRow> section(GuardedSimulation& guarded, const Key& link, double arc_length) {
  const Simulation& simulation = guarded.use();
  py::array_t<BeamRow> row(std::vector<py::ssize_t>{});
  *row.mutable_data() = row_of(simulation.section(link_index(simulation, link), arc_length));
  return row;
}

py::array_t<double> link_poses(GuardedSimulation& guarded) {
  const Simulation& simulation = guarded.use();
  return rows(simulation.link_names().size(), kPose,
              [&](std::size_t i, double* place) { put(simulation.link_pose(i), place); });
}

py::array_t<double> tip_poses(GuardedSimulation& guarded) {
  const Simulation& simulation = guarded.use();
  return rows(simulation.link_names().size(), kPose,
              [&](std::size_t i, double* place) { put(simulation.tip_pose(i), place); });
}

py::array_t<double> probe_poses(GuardedSimulation& guarded) {
  const Simulation& simulation = guarded.use();
  return rows(simulation.scene().probes.size(), kPose,
              [&](std::size_t i, double* place) { put(simulation.probe_pose(i), place); });
}

py::array_t<double> probe_velocities(GuardedSimulation& guarded) {
  const Simulation& simulation = guarded.use();
  return rows(simulation.scene().probes.size(), 6, [&](std::size_t i, double* place) {
    const ProbeState probe = simulation.probe(i);
    put(probe.angular_velocity, put(probe.velocity, place));
  });
}

py::array_t<double> probe_accelerations(GuardedSimulation& guarded) {
  const Simulation& simulation = guarded.use();
  return rows(simulation.scene().probes.size(), 6, [&](std::size_t i, double* place) {
    const ProbeAcceleration acceleration = simulation.probe_acceleration(i);
    put(acceleration.angular, put(acceleration.linear, place));
  });
}

py::array_t<double> sample(GuardedSimulation& guarded, const Key& sensor) {
  const Simulation& simulation = guarded.use();
  const std::size_t index = sensor_index(simulation, sensor);
  const SensorSample& sample = simulation.sample(index);
  return numbers(scene::sensor_channels(simulation.scene().sensors[index].kind).size(),
                 [&](std::size_t i) { return sample.values[i]; });
}

py::array_t<double> reaction(GuardedSimulation& guarded, const Key& link) {
  const Simulation& simulation = guarded.use();
  py::array_t<double> numbers(6);
  put(simulation.reaction(link_index(simulation, link)), numbers.mutable_data());
  return numbers;
}

}  // namespace

void bind_frames(py::module_& module, SimulationClass& type) {
  PYBIND11_NUMPY_DTYPE(BeamRow, arc_length, pose, strain, resultant);
  module.attr("beam_point_type") = py::dtype::of<BeamRow>();
  type.def_property_readonly("link_poses", &link_poses,
                             "poses of the frames of links, shape (links, 7): x y z [m], quaternion x y z w")
      .def_property_readonly(
          "tip_poses", &tip_poses,
          "poses of the last sections of beams, and of the frames of links without beams, shape (links, 7): "
          "x y z [m], quaternion x y z w")
      .def_property_readonly("probe_poses", &probe_poses,
                             "poses of probes, shape (probes, 7): x y z [m], quaternion x y z w")
      .def_property_readonly("probe_velocities", &probe_velocities,
                             "velocities of probes, shape (probes, 6): linear x y z [m/s], angular x y z [rad/s]")
      .def_property_readonly("probe_accelerations", &probe_accelerations,
                             "accelerations of probes, shape (probes, 6): linear x y z [m/s^2], angular x y z "
                             "[rad/s^2]; zero before the second "
                             "step")
      .def("beam_points", &beam_points,
           R"(Points of a beam: at every node, and `between` ones inside each pair of nodes.

A structured array, shape (points,). Its fields are arrays:
  arc_length: along the undeformed line, shape (points,) [m]
  pose: of the section, shape (points, 7): x y z [m], quaternion x y z w
  strain: shape (points, 6), in the section's axes: axial and shear [-], torsion and bending [1/m]
  resultant: elastic stress resultants, shape (points, 6), in the section's axes: force [N], moment [N m]
Empty if the link has no beam; strains and resultants of beams without elements are NaN.)",
           py::arg("link"), py::arg("between") = 0)
      .def("section", &section, R"(The section of a flexible link at an arc length of its undeformed line [m].

One point, with the fields of beam_points(), shape (). Raises ValueError if the link is rigid or its line is shorter.)",
           py::arg("link"), py::arg("arc_length"))
      .def("sample", &sample, R"(The last measurement of a sensor, with its errors, shape (channels,).

The channels and their units are those of the columns sensor/NAME/..., see columns().)",
           py::arg("sensor"))
      .def("reaction", &reaction, R"(Force [N] and moment [N m] on a link from the joint that carries it, shape (6,).

The moment is about the link's origin. Raises ValueError unless the link has a sensor of kind reaction or wrench.)",
           py::arg("link"));
}

}  // namespace flexarm::python
