// The stock firmware's command interpreter: bytes and times in, bytes and times out.
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bridges/emulation/delays.hpp"
#include "bridges/emulation/event_log.hpp"
#include "bridges/epuck_emulator/body.hpp"
#include "bridges/epuck_emulator/stepper.hpp"
#include "bridges/epuck_emulator/variant.hpp"

namespace tandem::bridges::epuck_emulator {

/// One byte at 115200 baud, 8N1: ten bits.
inline constexpr hal::TimeNs kByteNs = 86'806;

/// A byte on its way to the host, and when its stop bit has left the robot.
struct SentByte {
  std::uint8_t byte = 0;
  hal::TimeNs at = 0;
  friend bool operator==(const SentByte&, const SentByte&) = default;
};

/// A state machine in explicit time, without a clock, thread or file: what it does depends on its inputs alone. It has
/// the robot's manners, good and bad: one thing at a time (deaf while it answers, but for 64 bytes), no checks of what
/// it is told, and wheels that keep their last speed for ever.
class Firmware {
 public:
  struct Options {
    Variant variant = Variant::Gctronic;
    bool ground_board = true;    ///< three ground sensors
    bool cliff_sensors = false;  ///< two more, on versions that know them
    bool hardware_1_3 = true;    ///< e-puck1: the battery's voltage can be measured, not only whether it is empty
    std::uint8_t selector = 3;   ///< position of the rotary switch, 0 to 15
    hal::TimeNs boot_ns = 200 * hal::kNsPerMs;       ///< from a reset to the greeting; deaf meanwhile
    hal::TimeNs calibration_ns = hal::kNsPerSecond;  ///< between the two lines that answer K
    Delays delays{};                                 ///< those of the link are its server's
  };

  /// `body` must outlive the firmware. Nothing happens before `power_on`.
  Firmware(const Options& options, EmulatedBody& body, EventSink sink);

  /// The robot has been switched on and is ready at `at`: it sends its greeting.
  void power_on(hal::TimeNs at);

  /// A byte has come in completely at `at`. Times of all calls must not decrease.
  void receive(std::uint8_t byte, hal::TimeNs at);

  /// Does everything that the robot does until `now`.
  void run_until(hal::TimeNs now);

  /// Moves the bytes that have left by `now` to the end of `out`.
  void take_sent(hal::TimeNs now, std::vector<SentByte>& out);

  /// When `run_until` or `take_sent` will have something to do; nothing when the robot only waits for bytes. Bytes that
  /// leave one after the other may be collected for up to `patience_ns`.
  std::optional<hal::TimeNs> next_event(hal::TimeNs patience_ns = 0) const;

  /// The reset button (or a flat battery): wheels stop, what has not left yet never will, the greeting follows.
  void reset(hal::TimeNs at, std::string_view why);

  /// Loses the second half of the next answer.
  void cut_next_answer() { cut_next_answer_ = true; }

  const Options& options() const noexcept { return options_; }
  /// When a wheel first got a speed that is not 0.
  std::optional<hal::TimeNs> first_driven_at() const noexcept { return first_driven_at_; }

 private:
  static constexpr std::size_t kReceiveBytes = 64;
  static constexpr std::size_t kMarginBytes = 3 + 80;  // the firmware's one buffer: an image, its header, and some text

  enum class Mode : std::uint8_t { Idle, SkipToLine, Line, BinaryCommand, BinaryPayload };
  enum class Errand : std::uint8_t { None, Boot, Calibration, BusScan };
  enum class Camera : std::int32_t { Grey = 0, Rgb565 = 1, Yuv = 2 };

  /// What a reset forgets: the firmware's variables. A command with missing arguments finds those of the last one here.
  struct Memory {
    Mode mode = Mode::Idle;
    std::string line;
    int command = 0;  // binary: 256 - byte
    std::size_t payload_bytes = 0;
    std::vector<std::uint8_t> payload;
    std::vector<std::uint8_t> answer;
    std::int32_t speed_left = 0, speed_right = 0;
    std::int32_t led_index = 0, led_action = 0;
    std::int32_t count_left = 0, count_right = 0;
    std::int32_t sound = 0, ones = 0;
    std::int32_t bus_module = 0, bus_register = 0, bus_value = 0;
    std::int32_t camera_mode = 1, camera_width = 40, camera_height = 40, camera_zoom = 8;
    std::int32_t camera_x = -1, camera_y = -1;
    std::uint32_t frames = 0;
    std::array<int, 8> infrared_offset{};
    bool uart_error = false;
    bool obstacle_avoidance = false;
    BodyCommand lights;  // its speeds are not used
  };

  struct Arrived {
    std::uint8_t byte;
    hal::TimeNs at;
  };

  // firmware.cpp: time, bytes and devices
  void consume(std::uint8_t byte, hal::TimeNs at);
  void start_errand(Errand errand, hal::TimeNs until);
  void finish_errand();
  void send(std::span<const std::uint8_t> bytes, hal::TimeNs at);
  void send_text(std::string_view text, hal::TimeNs at);
  void greet(hal::TimeNs at);
  void calibrate(const BodySenses& senses) { memory_.infrared_offset = proximity(senses, false); }
  void set_speeds(std::int32_t left, std::int32_t right, std::string_view by, hal::TimeNs at);
  void turn_wheels(std::int32_t left, std::int32_t right, hal::TimeNs at);
  void stop_wheels(hal::TimeNs at);
  void turn_motors(hal::TimeNs now);
  void set_led(bool any_device, std::int32_t index, std::int32_t action, hal::TimeNs at);
  void show_lights(const BodyCommand& lights, hal::TimeNs at);
  void actuate(hal::TimeNs at);
  void count_steps(hal::TimeNs at);
  void play(std::int32_t sound, hal::TimeNs at);
  std::array<int, 3> acceleration(const BodySenses& senses, int zero) const;
  std::array<double, 3> ground(const BodySenses& senses) const;
  std::array<int, 8> proximity(const BodySenses& senses, bool calibrated) const;
  std::array<int, 3> gyro(const BodySenses& senses) const;
  int battery_raw(const BodySenses& senses) const;
  std::size_t image_bytes() const;
  void event(hal::TimeNs at, std::string_view name, const EventFields& fields) const;

  // firmware_ascii.cpp
  void obey_line(hal::TimeNs at);
  void obey_letter(char letter, std::string_view arguments, hal::TimeNs at);
  bool obey_question(char letter, hal::TimeNs at);
  bool obey_order(char letter, std::string_view arguments, hal::TimeNs at);
  bool obey_optional(char letter, std::string_view arguments, hal::TimeNs at);
  void scan(std::string_view arguments, std::initializer_list<std::int32_t*> variables) const;
  void set_camera(std::string_view arguments);

  // firmware_binary.cpp
  void take_command(std::uint8_t byte, hal::TimeNs at);
  std::optional<std::size_t> payload_of(int command) const;
  void obey_binary(hal::TimeNs at);
  void obey_binary_letter(char letter, hal::TimeNs at);
  void put8(std::int64_t value);
  void put16(std::int64_t value);
  void put_float(float value);
  void put_ground(const BodySenses& senses);
  void put_image();
  void put_sound_samples(const BodySenses& senses, hal::TimeNs at);
  std::int32_t payload16(std::size_t at) const;

  // firmware_epuck2.cpp
  std::optional<std::size_t> epuck2_payload_of(int command) const;
  void obey_epuck2(hal::TimeNs at);
  void set_all_actuators(hal::TimeNs at);
  void put_all_sensors(const BodySenses& senses);

  Options options_;
  const VariantFacts& facts_;
  EmulatedBody& body_;
  EventSink sink_;

  std::deque<Arrived> received_;  // at most kReceiveBytes
  bool overflowing_ = false;
  std::deque<SentByte> sending_;
  hal::TimeNs now_ = 0;
  hal::TimeNs free_at_ = 0;  // when the interpreter is done with what it is at
  Errand errand_ = Errand::None;
  bool greeted_ = false;
  hal::TimeNs errand_until_ = 0;
  bool cut_next_answer_ = false;
  std::optional<hal::TimeNs> first_driven_at_;

  Memory memory_;
  struct Speeds {
    std::int16_t left = 0, right = 0;
  };
  DelayLine<Speeds> to_motors_, to_counters_;
  Stepper left_, right_;                       // as the counters know them
  Stepper left_motor_, right_motor_;           // as the body does
  std::map<std::uint16_t, std::uint8_t> bus_;  // I2C: module and register to value
};

}  // namespace tandem::bridges::epuck_emulator
