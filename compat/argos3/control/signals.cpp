// Messages, lights and cameras.
#include <algorithm>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_base_leds_actuator.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_range_and_bearing_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_rgb_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_colored_blob_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_colored_blob_perspective_camera_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>
#include <array>

#include "compat/argos3/control/device.hpp"
#include "hal/device/argos_readings.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace argos {

constexpr UInt32 CCI_EPuckRangeAndBearingActuator::MAX_BYTES_SENT;
constexpr UInt32 CCI_EPuckRangeAndBearingSensor::MAX_BYTES_RECEIVED;

}  // namespace argos

namespace tandem::compat::argos3 {
namespace {

using argos::CByteArray, argos::CColor, argos::CRadians, argos::UInt32, argos::UInt8;
using hal::argos::kM_per_cm;

// --- messages ---

/// Sends in every tick.
template <class Port>
class Sender final : public ActuatorOn<argos::CCI_RangeAndBearingActuator, Port> {
 public:
  void begin() override { ClearData(); }
  void SetData(const CByteArray& data) override {
    if (data.Size() != bytes().Size())
      THROW_ARGOSEXCEPTION("a message of this robot has " << bytes().Size() << " bytes (rab_data_size), not "
                                                          << data.Size())
    bytes() = data;
    send();
  }
  void SetData(size_t i, UInt8 value) override {
    bytes()[i] = value;
    send();
  }
  void ClearData() override {
    bytes().Zero();
    send();
  }

 private:
  CByteArray& bytes() noexcept { return this->m_cData; }
  void fit(const Fitting& fitting) override {
    bytes().Resize(hal::message_bytes(fitting.kind, this->port().payload.size()));
  }
  /// All of it: loop functions may have changed the message.
  void send() {
    Port& port = this->port();
    port.sending = true;
    port.size = static_cast<UInt8>(bytes().Size());
    std::copy_n(bytes().ToCArray(), bytes().Size(), port.payload.begin());
  }
};

template <class Port>
class Receiver final : public SensorOn<argos::CCI_RangeAndBearingSensor, Port> {
 public:
  using typename argos::CCI_RangeAndBearingSensor::SPacket;
  using typename argos::CCI_RangeAndBearingSensor::TReadings;

  void sense() override {
    const Port& heard = this->port();
    TReadings& readings = this->m_tReadings;
    // Packets that are not needed now are kept, with their memory.
    while (readings.size() > heard.count) {
      spare_.push_back(std::move(readings.back()));
      readings.pop_back();
    }
    while (readings.size() < heard.count) {
      if (spare_.empty()) {
        readings.emplace_back();
      } else {
        readings.push_back(std::move(spare_.back()));
        spare_.pop_back();
      }
    }
    for (std::size_t i = 0; i < heard.count; ++i) {
      SPacket& packet = readings[i];
      packet.Range = static_cast<double>(heard.range_m[i]) / kM_per_cm;
      packet.HorizontalBearing.SetValue(static_cast<double>(heard.bearing_rad[i]));
      packet.VerticalBearing.SetValue(static_cast<double>(heard.elevation_rad[i]));
      packet.Data.Resize(std::min<std::size_t>(heard.size[i], Port::kPayload));
      std::copy_n(heard.message(i), packet.Data.Size(), packet.Data.ToCArray());
    }
  }

 private:
  TReadings spare_;
};

/// Sends what it was told last, until it is disabled.
template <class Port>
class EpuckSender final : public ActuatorOn<argos::CCI_EPuckRangeAndBearingActuator, Port> {
 public:
  using typename argos::CCI_EPuckRangeAndBearingActuator::TData;

  void begin() override { Disable(); }
  void SetData(const TData data) override {
    Port& port = this->port();
    port.sending = true;
    port.size = static_cast<UInt8>(size_);
    std::copy_n(data, size_, port.payload.begin());
  }
  void SetDataForEmitter(size_t, const TData) override {
    THROW_ARGOSEXCEPTION("this robot's board sends the same to all sides: use SetData instead of SetDataForEmitter")
  }
  void Disable() override { this->port() = {}; }
  void DisableEmitter(size_t) override {
    THROW_ARGOSEXCEPTION("this robot's board sends the same to all sides: use Disable instead of DisableEmitter")
  }

 private:
  void fit(const Fitting& fitting) override {
    size_ = std::min<std::size_t>(hal::message_bytes(fitting.kind, this->port().payload.size()), this->MAX_BYTES_SENT);
  }
  std::size_t size_ = 0;
};

/// Keeps packets until they are cleared.
template <class Port>
class EpuckReceiver final : public SensorOn<argos::CCI_EPuckRangeAndBearingSensor, Port> {
 public:
  using typename argos::CCI_EPuckRangeAndBearingSensor::SReceivedPacket;

  void begin() override { ClearPackets(); }
  void ClearPackets() override { this->m_tPackets.clear(); }
  void sense() override {
    constexpr std::size_t kBytes = argos::CCI_EPuckRangeAndBearingSensor::MAX_BYTES_RECEIVED;
    const Port& heard = this->port();
    auto& packets = this->m_tPackets;
    for (std::size_t i = 0; i < heard.count && packets.size() < kMost; ++i) {
      if (packets.size() == packets_.size()) packets_.push_back(std::make_unique<SReceivedPacket>());
      SReceivedPacket& packet = *packets_[packets.size()];
      packet.Range = static_cast<double>(heard.range_m[i]) / kM_per_cm;
      packet.Bearing.SetValue(static_cast<double>(heard.bearing_rad[i]));
      std::fill_n(packet.Data, kBytes, UInt8{0});
      std::copy_n(heard.message(i), std::min<std::size_t>(heard.size[i], kBytes), packet.Data);
      packets.push_back(&packet);
    }
  }

 private:
  static constexpr std::size_t kMost = 1000;
  std::vector<std::unique_ptr<SReceivedPacket>> packets_;
};

// --- lights ---

hal::Rgb rgb(const CColor& color) noexcept {
  const CColor shown = color.Blend(CColor(0, 0, 0));
  return {shown.GetRed(), shown.GetGreen(), shown.GetBlue()};
}

template <class Port, class Part>
class LedsOf final : public ActuatorOn<argos::CCI_LEDsActuator, Port> {
 public:
  using typename argos::CCI_LEDsActuator::TSettings;

  void begin() override { SetAllColors(CColor()); }
  void SetSingleColor(UInt32 led, const CColor& color) override {
    at(led) = color;
    show();
  }
  void SetAllColors(const CColor& color) override {
    std::fill(this->m_tSettings.begin(), this->m_tSettings.end(), color);
    show();
  }
  void SetAllColors(const TSettings& colors) override {
    if (colors.size() != this->m_tSettings.size())
      THROW_ARGOSEXCEPTION("the robot has " << this->m_tSettings.size() << " LEDs, not " << colors.size())
    this->m_tSettings = colors;
    show();
  }
  void SetSingleIntensity(UInt32 led, UInt8 intensity) override {
    at(led).SetAlpha(intensity);
    show();
  }
  void SetAllIntensities(UInt8 intensity) override {
    for (CColor& color : this->m_tSettings) color.SetAlpha(intensity);
    show();
  }

 private:
  void fit(const Fitting& fitting) override {
    const Part* const part = fitting.kind.part<Part>();
    this->m_tSettings.resize(part == nullptr ? 0 : part->mounts.size());
  }
  CColor& at(UInt32 led) {
    if (led >= this->m_tSettings.size())
      THROW_ARGOSEXCEPTION("the robot has the LEDs 0 to " << this->m_tSettings.size() - 1 << ", not " << led)
    return this->m_tSettings[led];
  }
  void show() {
    for (std::size_t i = 0; i < this->m_tSettings.size(); ++i) this->port().set(i, rgb(this->m_tSettings[i]));
  }
};

/// Three LEDs of a board that ours lacks: each is shown by the LEDs of the ring that are nearest to it.
class EpuckRgb final : public ActuatorOn<argos::CCI_EPuckRGBLEDsActuator, hal::RingLeds> {
 public:
  void begin() override { SetColors(CColor()); }
  void SetColor(size_t led, const CColor& color) override {
    if (led >= kLeds) THROW_ARGOSEXCEPTION("the e-puck's board has the LEDs 0 to 2, not " << led)
    m_tLEDSettings[led] = color;
    show();
  }
  void SetColors(const CColor& color) override {
    m_tLEDSettings.assign(kLeds, color);
    show();
  }
  void SetColors(const TLEDSettings& colors) override {
    if (colors.size() != kLeds) THROW_ARGOSEXCEPTION("the e-puck's board has 3 LEDs, not " << colors.size())
    m_tLEDSettings = colors;
    show();
  }

 private:
  static constexpr std::size_t kLeds = 3;
  void fit(const Fitting& fitting) override {
    constexpr std::array kBearings_rad = {ARGOS_PI / 3.0, -ARGOS_PI / 3.0, ARGOS_PI};  // left, right, behind
    m_tLEDSettings.resize(kLeds);
    shown_by_.clear();
    const auto* const part = fitting.kind.part<hal::LedsPart>();
    for (std::size_t i = 0; part != nullptr && i < part->mounts.size(); ++i) {
      const auto off = [&](double bearing) {
        return std::fabs(hal::argos::signed_angle(part->mounts[i].bearing_rad - bearing));
      };
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < kLeds; ++k) {
        if (off(kBearings_rad[k]) < off(kBearings_rad[nearest]) - 1e-9) nearest = k;
      }
      shown_by_.push_back(nearest);
    }
  }
  void show() {
    for (std::size_t i = 0; i < shown_by_.size(); ++i) port().set(i, rgb(m_tLEDSettings[shown_by_[i]]));
  }
  std::vector<std::size_t> shown_by_;  // of each LED of the ring
};

class EpuckRing final : public ActuatorOn<argos::CCI_EPuckBaseLEDsActuator, hal::RingLeds> {
 public:
  void begin() override { SwitchLEDs(false); }
  void SwitchLED(size_t led, bool on) override {
    if (led >= count_) THROW_ARGOSEXCEPTION("the e-puck has the LEDs 0 to " << count_ - 1 << ", not " << led)
    port().set(led, colour(on));
  }
  void SwitchLEDs(bool on) override {
    for (std::size_t i = 0; i < count_; ++i) port().set(i, colour(on));
  }

 private:
  static hal::Rgb colour(bool on) noexcept { return {static_cast<UInt8>(on ? 255 : 0), 0, 0}; }
  void fit(const Fitting& fitting) override {
    const auto* const part = fitting.kind.part<hal::LedsPart>();
    count_ = part == nullptr ? 0 : part->mounts.size();
  }
  std::size_t count_ = 0;
};

// --- cameras ---

/// `kOn`: the camera works from the start.
template <class Cci, class Port, bool kOn = false>
class CameraOf final : public SensorOn<Cci, Port> {
 public:
  using typename Cci::SBlob;

  void begin() override {
    this->m_bEnabled = kOn;
    reset();
  }
  void reset() override { this->m_sReadings = {}; }
  void Disable() override {
    Cci::Disable();
    this->m_sReadings.BlobList.clear();
  }
  void sense() override {
    const Port& camera = this->port();
    auto& list = this->m_sReadings.BlobList;
    while (blobs_.size() < camera.count) blobs_.push_back(std::make_unique<SBlob>());
    list.clear();
    for (std::size_t i = 0; i < camera.count; ++i) {
      SBlob& blob = *blobs_[i];
      const hal::Rgb c = camera.color(i);
      blob.Color.Set(c.r, c.g, c.b);
      if constexpr (requires { blob.Distance; }) {
        blob.Angle.SetValue(static_cast<double>(camera.bearing_rad[i]));
        blob.Distance = static_cast<double>(camera.distance_m[i]) / kM_per_cm;
      } else {
        blob.X = static_cast<argos::SInt32>(camera.x_px[i]);
        blob.Y = static_cast<argos::SInt32>(camera.y_px[i]);
      }
      if constexpr (requires { blob.Area; }) blob.Area = 1;
      list.push_back(&blob);
    }
    ++this->m_sReadings.Counter;
  }

 private:
  std::vector<std::unique_ptr<SBlob>> blobs_;
};

}  // namespace

std::span<const DeviceClass> signal_classes() {
  using namespace argos;
  using Leds = LedsOf<hal::RingLeds, hal::LedsPart>;
  using UpperLeds = LedsOf<hal::UpperRingLeds, hal::UpperLedsPart>;
  using OmniCci = CCI_ColoredBlobOmnidirectionalCameraSensor;
  using EpuckOmniCci = CCI_EPuckOmnidirectionalCameraSensor;
  using PerspectiveCci = CCI_ColoredBlobPerspectiveCameraSensor;
  // Robots of ARGoS files have the ports with more room, unless they are real.
  static const std::array all = {
      device_class<Sender<hal::RangeAndBearingSend>>("range_and_bearing"),
      device_class<Sender<hal::RangeAndBearingLongSend>>("range_and_bearing"),
      device_class<Receiver<hal::RangeAndBearing>>("range_and_bearing"),
      device_class<Receiver<hal::RangeAndBearingMany>>("range_and_bearing"),
      device_class<EpuckSender<hal::RangeAndBearingSend>>("epuck_range_and_bearing"),
      device_class<EpuckSender<hal::RangeAndBearingLongSend>>("epuck_range_and_bearing"),
      device_class<EpuckReceiver<hal::RangeAndBearing>>("epuck_range_and_bearing"),
      device_class<EpuckReceiver<hal::RangeAndBearingMany>>("epuck_range_and_bearing"),
      device_class<Leds>("leds"),
      device_class<UpperLeds>("upper_leds"),
      device_class<EpuckRgb>("epuck_rgb_leds"),
      device_class<EpuckRing>("epuck_base_leds"),
      device_class<CameraOf<OmniCci, hal::OmnidirectionalCamera>>("colored_blob_omnidirectional_camera"),
      device_class<CameraOf<OmniCci, hal::OmnidirectionalCameraMany>>("colored_blob_omnidirectional_camera"),
      device_class<CameraOf<EpuckOmniCci, hal::OmnidirectionalCamera, true>>("epuck_omnidirectional_camera"),
      device_class<CameraOf<EpuckOmniCci, hal::OmnidirectionalCameraMany, true>>("epuck_omnidirectional_camera"),
      device_class<CameraOf<PerspectiveCci, hal::PerspectiveCamera>>("colored_blob_perspective_camera"),
      device_class<CameraOf<PerspectiveCci, hal::PerspectiveCameraMany>>("colored_blob_perspective_camera")};
  return all;
}

}  // namespace tandem::compat::argos3
