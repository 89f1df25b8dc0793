#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "canyon/apps/options/mission_options.h"
#include "canyon/apps/options/why_options.h"
#include "canyon/study/compare.h"

namespace canyon::apps {

/// Options of the loop: without --open-loop each run drives by itself.
struct LoopOptions {
  bool open_loop = false;
  bool both = false;  ///< the open one beside the closed one; declared by who has several runs
  study::TapeChoice tape;
};
void declare_loop_options(Arguments& arguments, LoopOptions& options);
/// --both-loops, which compare alone has.
void declare_both_loops(Arguments& arguments, LoopOptions& options);
/// A tape without an open loop, and --open-loop where both are asked for.
Status check_loop_options(const LoopOptions& options);

/// What of the figures is asked for.
struct FigureOptions {
  std::string figures;                ///< keys of the rows of the table, with commas between; empty: all
  std::optional<std::int64_t> seeds;  ///< so many, the mission's own the first
};
void declare_figures_option(Arguments& arguments, FigureOptions& options);

/// What a run may leave out.
struct PlanOptions {
  std::string plan;     ///< empty: nothing; "make", or a plan file
  std::string outputs;  ///< that somebody will read; empty: not said
};
void declare_plan_options(Arguments& arguments, PlanOptions& options);

/// Drives the planned runs, writes results directory and report, prints the table or --json: what compare and run
/// share.
Result<int> drive_and_report(const MissionOptions& options, const LoopOptions& loop, const FigureOptions& figures,
                             const PlanOptions& leave_out, const mission::MissionFile& file,
                             const std::vector<study::RunPlan>& plan, const WhyOptions& why = {});

}  // namespace canyon::apps
