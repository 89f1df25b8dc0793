#include "canyon/mission/autonomy/call_watch.h"

#include <algorithm>
#include <exception>
#include <thread>

#include "canyon/core/config/text.h"
#include "canyon/core/process/progress.h"

namespace canyon::mission {
namespace {

constexpr double kGap_s =
    0.5;  // between two looks at most, or the process was stopped; the looker comes far more often

[[noreturn]] void sleep_for_ever() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(24));
}

}  // namespace

CallWatch::CallWatch(double limit_s)
    : limit_s_(limit_s),
      awake_(std::chrono::duration_cast<Time>(std::chrono::duration<double>(std::min(0.25 * limit_s, kGap_s)))) {}

std::optional<std::string> CallWatch::ask(const std::function<void()>& call) {
  const Time began = awake_.look();
  since_.store(began.count());
  std::uint64_t turn = turn_.fetch_add(1) + 1;
  std::optional<std::string> wrong;
  std::exception_ptr pass_on;
  try {
    call();
  } catch (const Cancelled&) {
    pass_on = std::current_exception();
  } catch (const std::exception& thrown) {
    wrong = std::string("it threw: ") + thrown.what();
  } catch (...) {
    wrong = "it threw what is no std::exception";
  }
  if (!turn_.compare_exchange_strong(turn, turn + 1)) sleep_for_ever();
  if (pass_on) std::rethrow_exception(pass_on);
  if (!wrong && over(began)) wrong = overtime();
  return wrong;
}

bool CallWatch::take_over() {
  awake_.look();
  std::uint64_t turn = turn_.load();
  if (turn % 2 == 0 || turn == kTaken) return false;
  const Time::rep since = since_.load();  // of a later call, if this one has returned: then the turn is another
  return over(Time(since)) && turn_.compare_exchange_strong(turn, kTaken);
}

bool CallWatch::over(Time since) {
  return std::chrono::duration<double>(awake_.look() - since).count() > limit_s_;
}

std::string CallWatch::overtime() const {
  return "a call took longer than autonomy.call_limit_s = " + number_text(limit_s_) + " s";
}

}  // namespace canyon::mission
