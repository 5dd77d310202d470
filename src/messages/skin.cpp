#include "messages/skin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "messages/colors.h"
#include "messages/conversions.h"

namespace flexarm::messages {
namespace {

/// An edge may reach over kLongestReach sections at most. Edges shorter than kShortestEdge times the distance between
/// two sections are never split, since the nearest point of the line may jump along any edge.
constexpr double kLongestReach = 2, kShortestEdge = 0.25;
/// Largest number of triangles of a skin; at this number splitting ends.
constexpr std::size_t kMostSkinTriangles = 60000;

}  // namespace

/// Splits triangles at the middle of the edge that reaches over the most sections, until none reaches too far.
/// Neighbours split their common edge at the same place, in whatever order, so there are no gaps.
class Skin::Splitter {
 public:
  Splitter(TriangleMesh mesh, const std::vector<Pose>& sections) : mesh_(std::move(mesh)), sections_(sections) {
    double length = 0;
    for (std::size_t k = 0; k + 1 < sections.size(); ++k)
      length += (sections[k + 1].position - sections[k].position).norm();
    shortest_ = kShortestEdge * length / static_cast<double>(sections.size() - 1);
    for (const TriangleMesh::Vertex& vertex : mesh_.vertices) places_.push_back(nearest(vertex.position));
  }

  void split() {
    std::vector<TriangleMesh::Triangle> waiting = std::move(mesh_.triangles), done;
    while (!waiting.empty()) {
      const TriangleMesh::Triangle triangle = waiting.back();
      waiting.pop_back();
      int worst = 0;
      for (int k = 1; k < 3; ++k)
        if (reach(triangle, k) > reach(triangle, worst)) worst = k;
      if (reach(triangle, worst) <= kLongestReach || waiting.size() + done.size() >= kMostSkinTriangles) {
        done.push_back(triangle);
        continue;
      }
      const int a = triangle[worst], b = triangle[(worst + 1) % 3], c = triangle[(worst + 2) % 3];
      const int middle = middle_of(a, b);
      waiting.push_back({a, middle, c});
      waiting.push_back({middle, b, c});
    }
    mesh_.triangles = std::move(done);
  }

  const TriangleMesh& mesh() const { return mesh_; }
  const std::vector<Place>& places() const { return places_; }

 private:
  Place nearest(const Vector3& point) const {
    Place best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < sections_.size(); ++k) {
      const Vector3 start = sections_[k].position, way = sections_[k + 1].position - start;
      const double square = way.squaredNorm();
      const double part = square > 0 ? std::clamp(way.dot(point - start) / square, 0.0, 1.0) : 0.0;
      const double distance = (start + part * way - point).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      best = {static_cast<int>(k), part};
    }
    return best;
  }
  /// Number of sections over which an edge reaches; 0 for a short edge.
  double reach(const TriangleMesh::Triangle& triangle, int edge) const {
    const int a = triangle[edge], b = triangle[(edge + 1) % 3];
    if ((mesh_.vertices[a].position - mesh_.vertices[b].position).norm() < shortest_) return 0;
    return std::abs(places_[a].along() - places_[b].along());
  }
  int middle_of(int a, int b) {
    const auto [entry, is_new] = middles_.try_emplace(std::minmax(a, b), static_cast<int>(mesh_.vertices.size()));
    if (!is_new) return entry->second;
    const TriangleMesh::Vertex &first = mesh_.vertices[a], &second = mesh_.vertices[b];
    const Vector3 position = 0.5 * (first.position + second.position);
    mesh_.add(position, Vector3(first.normal + second.normal).normalized());
    places_.push_back(nearest(position));
    return entry->second;
  }

  TriangleMesh mesh_;
  const std::vector<Pose>& sections_;
  double shortest_ = 0;  ///< [m]
  std::vector<Place> places_;
  std::map<std::pair<int, int>, int> middles_;  ///< vertex in the middle of an edge, by the edge's two vertices
};

Skin::Skin(const TriangleMesh& mesh, const std::vector<Pose>& sections) {
  Splitter splitter(mesh, sections);
  splitter.split();
  for (std::size_t i = 0; i < splitter.places().size(); ++i)
    attach(splitter.mesh().vertices[i], splitter.places()[i], sections);
  triangles_ = splitter.mesh().triangles;
}

Skin Skin::tube(const std::vector<Pose>& sections, double radius) {
  const TriangleMesh mesh = tube_mesh(sections, std::vector<double>(sections.size(), radius));
  const int last = static_cast<int>(sections.size()) - 1;
  const std::size_t wall = kSides * sections.size(), cap = kSides + 1;
  Skin skin;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    // Assigned by index, not by the nearest section, which may belong to another turn of a coil.
    const int section = i < wall ? static_cast<int>(i / kSides) : i < wall + cap ? 0 : last;
    skin.attach(mesh.vertices[i], section < last ? Place{section, 0} : Place{last - 1, 1}, sections);
  }
  skin.triangles_ = mesh.triangles;
  return skin;
}

void Skin::attach(const TriangleMesh::Vertex& vertex, const Place& place, const std::vector<Pose>& sections) {
  Vertex& out = vertices_.emplace_back();
  out.place = place;
  for (int k = 0; k < 2; ++k) {
    const Pose to_section = sections[place.section + k].inverse();
    out.in_section[k] = {to_section * vertex.position, to_section.orientation * vertex.normal};
  }
}

void Skin::draw(const std::vector<Section>& sections, visualization_msgs::Marker& marker) {
  rotations_.clear();
  for (const Section& section : sections) rotations_.push_back(section.pose.orientation.toRotationMatrix());
  corners_.clear();
  for (const Vertex& vertex : vertices_) {
    Vector3 position = Vector3::Zero(), normal = Vector3::Zero();
    double strain = 0;
    for (int k = 0; k < 2; ++k) {
      const double weight = k == 0 ? 1 - vertex.place.part : vertex.place.part;
      const int section = vertex.place.section + k;
      position += weight * (sections[section].pose.position + rotations_[section] * vertex.in_section[k].position);
      normal += weight * (rotations_[section] * vertex.in_section[k].normal);
      strain += weight * sections[section].strain;
    }
    corners_.push_back({to_point(position), lit(strain_color(strain), normal)});
  }
  marker.points.reserve(marker.points.size() + 3 * triangles_.size());
  marker.colors.reserve(marker.colors.size() + 3 * triangles_.size());
  for (const TriangleMesh::Triangle& triangle : triangles_)
    for (const int vertex : triangle) {
      marker.points.push_back(corners_[vertex].point);
      marker.colors.push_back(corners_[vertex].color);
    }
}

}  // namespace flexarm::messages
