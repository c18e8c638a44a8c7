// Frame encoder: the messages that show a frame (docs/view-protocol.md), and what a viewer still lacks of them.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "window/frame.hpp"

namespace tandem::window {

/// Text or binary; shared by all viewers that get it.
struct Message {
  std::shared_ptr<const std::string> bytes;
  bool binary = false;
};

/// What one viewer has got. As it is made: nothing.
struct ViewerState {
  std::uint32_t frame = 0;  ///< the number of the last frame
  std::uint32_t scene = 0, members = 0;
  std::uint64_t marks = 0;
  std::map<std::uint32_t, std::uint64_t> layers;  ///< by index: which drawing
};

/// Values of members, and which frame changed each.
template <class T>
struct Changing {
  std::vector<T> known;
  std::vector<std::uint32_t> changed;  ///< 0: never, it is as it was at first

  /// As many as there are of them from now on, all unknown.
  void forget() noexcept {
    known.clear();
    changed.clear();
  }
  void note(const T* now, std::size_t count, std::uint32_t frame) {
    known.resize(count, T{});
    changed.resize(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      if (known[i] == now[i]) continue;
      known[i] = now[i];
      changed[i] = frame;
    }
  }
};

/// Used by one thread. LEDs, what moves on robots, and objects are sent as far as they changed since a viewer's last
/// frame, so that a viewer may miss frames.
class FrameEncoder {
 public:
  /// LEDs one by one are shown of so many robots at most.
  static constexpr std::size_t kMostRobotsWithLeds = 2000;
  static constexpr std::size_t kRowBytes = 16;

  /// @param file_suffix is put behind the address of the floor: "&token=…"
  explicit FrameEncoder(std::string file_suffix) : file_suffix_(std::move(file_suffix)) {}

  /// Makes this the frame that is shown. @returns the one before, for its memory
  Frame take(Frame&& frame);
  /// Of the frame that is shown; 0: none yet.
  std::uint32_t number() const noexcept { return number_; }
  const Frame& frame() const noexcept { return frame_; }

  /// Appends what brings a viewer with these layers up to date, in the order in which it is to be sent.
  void update(ViewerState& viewer, const std::vector<std::uint32_t>& layers, std::vector<Message>& out);

 private:
  struct Layer {
    std::uint64_t drawing = 0;
    Message lines, texts;
  };
  void note_objects();
  void note_marks();
  Message poses() const;
  template <class T, class Put>
  Message changes_since(std::uint32_t frame, std::uint32_t type, const std::vector<std::uint32_t>& first,
                        const Changing<T>& values, Put&& put) const;
  Message objects_since(std::uint32_t frame) const;
  std::string header(std::uint32_t type, std::uint32_t number, std::size_t count) const;

  std::string file_suffix_;
  std::uint32_t number_ = 0;
  Frame frame_;
  Message poses_, scene_, members_, marks_;
  std::uint64_t marks_version_ = 0;
  Changing<hal::Rgb> leds_;
  Changing<float> values_;
  std::vector<std::uint32_t> halted_;
  std::map<std::uint32_t, std::pair<FrameObject, std::uint32_t>> objects_;  // by number, and the frame that moved it
  std::map<std::uint32_t, Message> leds_of_, values_of_, objects_of_;       // by the viewer's last frame; of this frame
  std::map<std::uint32_t, Layer> layers_;
  std::uint64_t drawings_ = 0;
};

/// Of cos and sin of an angle: 0 to 65535, a turn being 65536. Within one of the exact number.
std::uint16_t turns_of(double cos, double sin) noexcept;

}  // namespace tandem::window
