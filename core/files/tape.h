#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/core/truth.h"

namespace canyon {

/// One instant of a tape. `motion.t` counts from the tape's own start (t = 0 there), so that a tape can be laid at any
/// time.
struct TapeNode {
  KinematicState motion;
  double speed_m_s = 0.0;   ///< along B's x
  double distance_m = 0.0;  ///< driven since the start
  DriveCommand command;     ///< under which the vehicle came here; zero where nobody asked for anything
};

/// A recording of true motion: on it sensors, filters and methods can be compared on the same motion and the same draws
/// (open loop). Nodes are exact and as dense as the steps of a run; what lies between them is TrueMotion's.
struct Tape {
  std::string source;      ///< where it comes from, for people: "low of results/a", "drive.tum"
  std::string scene_hash;  ///< of the scene it was recorded in; empty: of no scene, as a trajectory file
  std::string traffic;     ///< [[scene.moving]] as it was, as JSON
  std::vector<TapeNode> nodes;

  double duration_s() const { return nodes.empty() ? 0.0 : nodes.back().motion.t - nodes.front().motion.t; }
};

/// A tape file: a line of JSON that says what follows, then the nodes as little-endian numbers of 8 bytes
/// (docs/results.md). An Error for what is no tape, is cut off, or holds what is not finite or goes back in time.
Result<Tape> read_tape(const std::string& path);

/// The first line of a tape file, and the bytes of one node: a recorder writes them as they come.
std::string tape_header(const Tape& tape);
void append_tape_node(std::string& out, const TapeNode& node);

/// SHA-256 of its motion: of the nodes as a file holds them, whatever the tape is called.
std::string tape_hash(const Tape& tape);

}  // namespace canyon
