#pragma once
/// Bounds against absurd input. Each is far above any sensible scene, and small enough that reading takes seconds.

#include <cstddef>

namespace flexarm::scene {

constexpr std::size_t kLargestFile = 16u << 20;  ///< bytes
constexpr int kDeepestNesting = 32;              ///< elements inside one another
constexpr int kMostAttributes = 1000;  ///< of an element: the time of parsing grows with the square of their number
constexpr std::size_t kMostLinks = 10000;
constexpr std::size_t kMostJoints = 10000;
constexpr std::size_t kMostSimulationEntries = 10000;  ///< children of <simulation>
constexpr std::size_t kMostSensors = 10000;
constexpr std::size_t kMostForceElements = 10000;     ///< between points of links
constexpr int kMostVias = 2000;                       ///< points of a tendon
constexpr std::size_t kMostContacts = 1000;           ///< grounds, and named pairs
constexpr std::size_t kMostCentrelinePieces = 10000;  ///< per beam
constexpr double kLongestPiece = 1e9;                 ///< length of a piece of a centreline, and radius of an arc [m]
constexpr std::size_t kMostProfilePoints = 10000;     ///< of a cam
constexpr int kLongestDelay = 10000;                  ///< delay of a servo, in its sample times
constexpr int kMostBeamElements = 100000;             ///< per beam
constexpr int kMostBeamNodes = 200000;                ///< of all beams; such a model takes 2 GB of memory
constexpr int kMostNewtonIterations = 1000;
constexpr int kMostHalvings = 30;  ///< the smallest step is the step divided by 2^30
constexpr std::size_t kMostParameters = 1000;
constexpr std::size_t kMostExpressions = 100000;    ///< in attributes; their evaluation takes a second
constexpr std::size_t kLongestName = 256;           ///< bytes, of links, joints, probes and sensors
constexpr std::size_t kLongestParameterName = 100;  ///< bytes: muParser's limit for an identifier
constexpr std::size_t kLongestShownValue = 80;      ///< bytes of a value repeated in a message
constexpr std::size_t kMostFindings = 1000;         ///< listed one by one; further ones are only counted

}  // namespace flexarm::scene
