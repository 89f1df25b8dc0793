#include "canyon/mission/mission_run.h"

// What is due of the sensors beside IMU, receiver and LIDAR.
namespace canyon::mission {

template <class Reading>
Status MissionRun::hand_on(const Reading& reading, const char* counter, Status (Recorder::*keep)(const Reading&)) {
  CANYON_TRY_STATUS(boundaries_.check(reading.message));
  ++record_.counters[counter];
  CANYON_TRY_STATUS((recorder_.*keep)(reading));
  return localizer_.once_at(reading.message.t, [this, message = reading.message] { return localizer_.aid(message); });
}

Status MissionRun::take_odometer(const Due& due) {
  const auto reading = clock_.charge(Part::kImu, [&] { return aiding_.count(due.k - 1, motion_, due.t); });
  CANYON_TRY_STATUS(hand_on(reading, "odometer_samples", &Recorder::odometer));
  if (omissions_.autonomy) return Ok{};
  return localizer_.once_at(due.t, [this, sample = reading.message]() -> Status {
    clock_.charge(Part::kAutonomy, [&] { ask([&] { autonomy_->count(sample); }); });
    return Ok{};
  });
}

Status MissionRun::take_barometer(const Due& due) {
  const auto reading = clock_.charge(Part::kImu, [&] { return aiding_.pressure(due.k - 1, truth_at(due.t)); });
  return hand_on(reading, "barometer_samples", &Recorder::barometer);
}

Status MissionRun::take_magnetometer(const Due& due) {
  const auto reading = clock_.charge(Part::kImu, [&] { return aiding_.field(due.k - 1, truth_at(due.t)); });
  return hand_on(reading, "magnetometer_samples", &Recorder::magnetometer);
}

}  // namespace canyon::mission
