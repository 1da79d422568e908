// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "components/runtime/dds/participant.hpp"

namespace swiftlet {

/// A frame that is being written in the memory where readers will find it, to be handed to
/// Publisher::publish. One that is not published gives its memory back. Its content is unspecified
/// at first: what an earlier frame left there. Where all memory is lent or readers keep it, the
/// frame lies elsewhere and is copied when it is published; nobody but a stopwatch notices.
template <class T>
class Loan {
 public:
  explicit Loan(std::shared_ptr<Writer> writer)
      : writer_(std::move(writer)), frame_(static_cast<T*>(writer_->loan())) {
    if (frame_ != nullptr) return;
    own_ = std::make_unique<T>();
    frame_ = own_.get();
  }
  ~Loan() {
    if (frame_ != nullptr && own_ == nullptr) writer_->discard_loan(frame_);
  }
  Loan(Loan&& other) noexcept
      : writer_(std::move(other.writer_)),
        own_(std::move(other.own_)),
        frame_(std::exchange(other.frame_, nullptr)) {}
  Loan& operator=(Loan&& other) noexcept {
    std::swap(writer_, other.writer_);
    std::swap(own_, other.own_);
    std::swap(frame_, other.frame_);
    return *this;
  }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;

  T& operator*() { return *frame_; }
  T* operator->() { return frame_; }
  /// Whether readers will find the frame where it is now.
  bool in_place() const { return own_ == nullptr; }

 private:
  template <class>
  friend class Publisher;

  void publish() {
    if (own_ == nullptr) {
      writer_->write_loan(std::exchange(frame_, nullptr));
    } else {
      writer_->write(frame_);
    }
  }

  std::shared_ptr<Writer> writer_;
  std::unique_ptr<T> own_;
  T* frame_;
};

}  // namespace swiftlet
