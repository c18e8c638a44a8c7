// Devices that a puppet takes where its configuration lists them, and does without otherwise.
#pragma once
#include "hal/controller.hpp"

namespace tandem::controllers {

template <class... Port>
void take_listed_sensors(hal::Robot& robot) {
  const auto take = [&]<class P>() {
    try {
      robot.sensor<P>();
    } catch (const hal::DeviceError&) {  // it does without
    }
  };
  (take.template operator()<Port>(), ...);
}

template <class... Port>
void take_listed_actuators(hal::Robot& robot) {
  const auto take = [&]<class P>() {
    try {
      robot.actuator<P>();
    } catch (const hal::DeviceError&) {
    }
  };
  (take.template operator()<Port>(), ...);
}

}  // namespace tandem::controllers
