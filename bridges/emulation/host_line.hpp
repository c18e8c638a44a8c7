// Interface of the line between an emulated robot and its host: bytes both ways.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "hal/result.hpp"

namespace tandem::bridges {

/// The robot's end. Nothing here blocks.
class HostLine {
 public:
  virtual ~HostLine() = default;

  /// For poll(); another one after each `read`, perhaps.
  virtual int descriptor() const noexcept = 0;
  /// What has come in, up to the size of `buffer`; 0 when nothing has. Errors: the line has gone for good.
  virtual hal::Result<std::size_t> read(std::span<std::uint8_t> buffer) = 0;
  /// @returns how many bytes went out; the rest is lost, as on a wire without a listener
  virtual std::size_t write(std::span<const std::uint8_t> bytes) = 0;
  /// The baud rate that the host has set on its side, 0 for one that is not usual; the robot's own where there is none.
  virtual unsigned long host_baud() const = 0;
  /// What a host opens: the name of a device, or a LINK text.
  virtual const std::string& path() const noexcept = 0;
  /// What `path` points at; "": nothing.
  virtual const std::string& device() const noexcept = 0;
  /// LINK text that opens the same line again.
  virtual const std::string& link() const noexcept = 0;
};

}  // namespace tandem::bridges
