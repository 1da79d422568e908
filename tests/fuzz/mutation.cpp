// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/mutation.hpp"

#include <algorithm>
#include <iterator>

namespace swiftlet::fuzz {
namespace {

constexpr int kMostChanges = 4;
constexpr std::size_t kLongestInsert = 64;

class Mutation {
 public:
  Mutation(Bytes bytes, const Bytes& other, std::mt19937& random)
      : bytes_(std::move(bytes)), other_(other), random_(random) {}

  Bytes result(std::size_t limit) {
    for (std::size_t left = 1 + pick(kMostChanges); left > 0; --left) change();
    bytes_.resize(std::min(bytes_.size(), limit));
    return std::move(bytes_);
  }

 private:
  std::size_t pick(std::size_t count) { return count == 0 ? 0 : random_() % count; }
  Bytes::iterator at(std::size_t place) {
    return bytes_.begin() + static_cast<std::ptrdiff_t>(place);
  }

  void change() {
    if (bytes_.empty()) return insert();
    switch (pick(9)) {
      case 0:
      case 1:
        bytes_[pick(bytes_.size())] ^= static_cast<std::uint8_t>(1U << pick(8));
        return;
      case 2:
        bytes_[pick(bytes_.size())] = static_cast<std::uint8_t>(random_());
        return;
      case 3:
      case 4:
        return write_number();
      case 5:
        return erase();
      case 6:
        return insert();
      case 7:
        return double_a_part();
      default:
        return splice();
    }
  }

  /// Of one, two, four or eight bytes, in either order, mostly where such a number would be
  /// aligned.
  void write_number() {
    const std::uint64_t numbers[] = {
        0,      1,          2,         0x7f,          0x80,       0xff,
        0x7fff, 0x8000,     0xffff,    0x7fffffff,    0x80000000, 0xffffffff,
        ~0ULL,  ~0ULL >> 1, ~0ULL - 8, bytes_.size(), random_()};
    const std::uint64_t number = numbers[pick(std::size(numbers))];
    const std::size_t width = std::size_t{1} << pick(4);
    if (width > bytes_.size()) return;
    std::size_t place = pick(bytes_.size() - width + 1);
    if (pick(4) != 0) place -= place % std::min<std::size_t>(width, 4);
    const bool big_endian = pick(4) == 0;
    for (std::size_t i = 0; i < width; ++i) {
      bytes_[place + (big_endian ? width - 1 - i : i)] =
          static_cast<std::uint8_t>(number >> (8 * i));
    }
  }

  void erase() {
    const std::size_t begin = pick(bytes_.size());
    const std::size_t length = pick(2) == 0 ? bytes_.size() : 1 + pick(kLongestInsert);
    bytes_.erase(at(begin), at(std::min(bytes_.size(), begin + length)));
  }

  void insert() {
    bytes_.insert(at(pick(bytes_.size() + 1)), 1 + pick(kLongestInsert),
                  static_cast<std::uint8_t>(pick(2) == 0 ? 0 : random_()));
  }

  void double_a_part() {
    const std::size_t begin = pick(bytes_.size());
    const std::size_t length = 1 + pick(std::min<std::size_t>(bytes_.size() - begin, 4096));
    const Bytes part(at(begin), at(begin + length));
    for (std::size_t times = 1 + pick(8); times > 0; --times) {
      bytes_.insert(at(begin), part.begin(), part.end());
    }
  }

  /// Our beginning and the end of the other.
  void splice() {
    if (other_.empty()) return;
    bytes_.erase(at(pick(bytes_.size() + 1)), bytes_.end());
    const auto begin = other_.begin() + static_cast<std::ptrdiff_t>(pick(other_.size()));
    bytes_.insert(bytes_.end(), begin, other_.end());
  }

  Bytes bytes_;
  const Bytes& other_;
  std::mt19937& random_;
};

}  // namespace

Bytes mutated(const Bytes& seed, const Bytes& other, std::size_t limit, std::mt19937& random) {
  return Mutation(seed, other, random).result(limit);
}

}  // namespace swiftlet::fuzz
