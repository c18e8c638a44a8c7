// Serial port of an emulated robot: a pseudo-terminal under a name of our own, or a real serial device.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "bridges/emulation/host_line.hpp"
#include "hal/result.hpp"

namespace tandem::bridges {

/// The robot's end of a serial line, raw, 8N1, no flow control. Nothing here blocks.
class SerialPort final : public HostLine {
 public:
  /// "pty:NAME" makes a pseudo-terminal and a symbolic link NAME to it, in the current folder unless NAME is a path; a
  /// link of that name is replaced. "serial:DEVICE" or "serial:DEVICE@BAUD" opens a device, for a robot at the end of
  /// a cable. `robot` is its name in messages, `baud` its speed: one of those of `host_baud`. Errors: other links, or
  /// another speed; NAME is something else than a symbolic link; the folder or the device cannot be opened.
  static hal::Result<std::unique_ptr<SerialPort>> open(const std::string& link, const std::string& robot,
                                                       unsigned long baud);

  /// Takes the symbolic link away, if it is still ours.
  ~SerialPort() override;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// For poll().
  int descriptor() const noexcept override { return descriptor_; }

  /// What has come in, up to the size of `buffer`; 0 when nothing has. Errors: the device has gone.
  hal::Result<std::size_t> read(std::span<std::uint8_t> buffer) override;

  /// @returns how many bytes went out; the rest is lost, as on a wire without a listener
  std::size_t write(std::span<const std::uint8_t> bytes) override;

  /// The baud rate that the host has set on its side of a pseudo-terminal, 0 for one that is not usual; the robot's own
  /// on a device.
  unsigned long host_baud() const override;

  /// The name that a host opens.
  const std::string& path() const noexcept override { return path_; }
  /// What `path` points at.
  const std::string& device() const noexcept override { return device_; }
  const std::string& link() const noexcept override { return link_; }

 private:
  explicit SerialPort(unsigned long baud) : baud_(baud) {}
  hal::Status make_terminal(const std::string& path);
  hal::Status open_device(const std::string& device);

  unsigned long baud_;
  int descriptor_ = -1;
  int slave_ = -1;  // kept open: without any, the robot's end of a pseudo-terminal reports a hang-up
  std::string path_;
  std::string device_;
  std::string link_;
  bool owns_link_ = false;
};

}  // namespace tandem::bridges
