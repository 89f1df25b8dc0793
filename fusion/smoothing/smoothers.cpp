#include "canyon/fusion/smoothing/smoother.h"

namespace canyon::fusion {
namespace {

constexpr ModelRow<MakeSmoother> kSmoothers[] = {
    {"none", make_filter_alone, "the filter's estimate as it was at each instant", forward_backward_parameters},
    {"rts", make_rts, "the filter's estimate, and what came later (Rauch, Tung & Striebel)",
     forward_backward_parameters},
    {"batch_graph", make_batch_graph, "a factor graph of the whole run, solved until nothing moves", graph_parameters},
    {"fixed_lag_graph", make_fixed_lag_graph, "a factor graph of the last seconds, with each fix anew",
     fixed_lag_graph_parameters},
};

/// Rows of which a graph gets no messages.
constexpr std::string_view kNotOfGraphs[] = {"barometer", "magnetometer", "heading", "map_pose"};

}  // namespace

std::vector<std::string> not_smoothed_by(std::string_view smoother, const FilterConfig& config) {
  std::vector<std::string> out;
  if (smoother.ends_with("graph"))
    for (const std::string_view name : kNotOfGraphs)
      if (measures_with(config, name)) out.emplace_back(name);
  return out;
}

ModelTable<MakeSmoother> smoothers() {
  return kSmoothers;
}

}  // namespace canyon::fusion
