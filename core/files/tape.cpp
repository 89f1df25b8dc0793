#include "canyon/core/files/tape.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"

namespace canyon {
namespace {

static_assert(std::endian::native == std::endian::little, "tapes are little-endian");

constexpr const char* kKind = "canyon-tape-1";
constexpr std::size_t kNumbers = 23;
constexpr std::size_t kNodeBytes = 8 * (1 + kNumbers);

/// The numbers of a node in the order of the file; `number` reads or writes one.
template <class Node, class Number>
void visit_numbers(Node& node, Number number) {
  auto& m = node.motion;
  for (int i = 0; i < 3; ++i) number(m.X_WB.p[i]);
  for (double* part : {&m.X_WB.R.w(), &m.X_WB.R.x(), &m.X_WB.R.y(), &m.X_WB.R.z()}) number(*part);
  for (auto* vector : {&m.v_WB_W, &m.a_WB_W, &m.w_WB_B, &m.alpha_WB_B})
    for (int i = 0; i < 3; ++i) number((*vector)[i]);
  number(node.speed_m_s);
  number(node.distance_m);
  number(node.command.speed_m_s);
  number(node.command.curvature_1_m);
}

Error no_tape(const std::string& path, std::string what) {
  return Error{.file = path, .what = std::move(what), .expected = "a tape that canyon wrote"};
}

TapeNode parse_node(const char* bytes) {
  TapeNode node;
  std::memcpy(&node.motion.t.ns, bytes, 8);
  visit_numbers(node, [&](double& value) { std::memcpy(&value, bytes += 8, 8); });
  return node;
}

Status check_nodes(const std::string& path, const std::vector<TapeNode>& nodes) {
  if (nodes.size() < 2) return no_tape(path, std::to_string(nodes.size()) + " nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    TapeNode copy = nodes[i];
    bool finite = true;
    visit_numbers(copy, [&](double& value) { finite = finite && std::isfinite(value); });
    if (!finite || std::abs(copy.motion.X_WB.R.norm() - 1.0) > 1e-9)  // rounding of a unit quaternion: a few 1e-16
      return no_tape(path, "node " + std::to_string(i + 1) + " is no motion");
    if (i > 0 && nodes[i].motion.t <= nodes[i - 1].motion.t)
      return no_tape(path, "node " + std::to_string(i + 1) + " does not come after the one before");
  }
  return Ok{};
}

}  // namespace

std::string tape_header(const Tape& tape) {
  const nlohmann::ordered_json header{{"kind", kKind},
                                      {"source", tape.source},
                                      {"scene_hash", tape.scene_hash},
                                      {"traffic", tape.traffic},
                                      {"node_bytes", kNodeBytes}};
  return json_text(header) + "\n";
}

void append_tape_node(std::string& out, const TapeNode& node) {
  const auto append = [&out](const auto& value) {
    char bytes[8];
    std::memcpy(bytes, &value, 8);
    out.append(bytes, 8);
  };
  append(node.motion.t.ns);
  TapeNode copy = node;
  visit_numbers(copy, append);
}

Result<Tape> read_tape(const std::string& path) {
  CANYON_TRY(const std::string bytes, read_text_file(path));
  const std::size_t end = bytes.find('\n');
  const auto header = parse_json(std::string_view(bytes).substr(0, end == std::string::npos ? 0 : end), path);
  if (!header.ok() || json_string(*header, "kind") != kKind) return no_tape(path, "does not begin as a tape");
  const std::size_t rest = bytes.size() - end - 1;
  if (rest % kNodeBytes != 0) return no_tape(path, "ends within a node");
  Tape tape{.source = json_string(*header, "source"),
            .scene_hash = json_string(*header, "scene_hash"),
            .traffic = json_string(*header, "traffic"),
            .nodes = {}};
  tape.nodes.reserve(rest / kNodeBytes);
  for (std::size_t at = end + 1; at < bytes.size(); at += kNodeBytes) tape.nodes.push_back(parse_node(&bytes[at]));
  CANYON_TRY_STATUS(check_nodes(path, tape.nodes));
  return tape;
}

std::string tape_hash(const Tape& tape) {
  std::string bytes;
  bytes.reserve(tape.nodes.size() * kNodeBytes);
  for (const TapeNode& node : tape.nodes) append_tape_node(bytes, node);
  return sha256_hex(bytes);
}

}  // namespace canyon
