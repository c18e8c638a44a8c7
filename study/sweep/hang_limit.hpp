// Ends the process of a worker whose step does not return, so that a sweep goes on at night.
#pragma once

namespace tandem::study {

/// A timer of the system looks once a second whether there was a step. One in a process, which it ends with a message
/// for people that names the controller or hook.
class HangLimit {
 public:
  /// Real time that a step may take; 0: any.
  explicit HangLimit(double limit_s) noexcept : limit_s_(limit_s) {}

  /// Looks while it lives.
  class Watched {
   public:
    explicit Watched(const HangLimit& limit) noexcept;
    ~Watched();
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;
  };

  /// Before every step.
  static void step() noexcept;

 private:
  double limit_s_;
};

}  // namespace tandem::study
