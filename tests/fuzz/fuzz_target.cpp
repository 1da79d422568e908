// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz_target.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <new>

namespace {

thread_local std::size_t allocated_bytes = 0;

void* counted_or_null(std::size_t size) {
  allocated_bytes += size;
  return std::malloc(size == 0 ? 1 : size);
}

void* counted(std::size_t size) {
  void* memory = counted_or_null(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return counted_or_null(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return counted_or_null(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace swiftlet::fuzz {

std::size_t allocated() {
  return allocated_bytes;
}

FileInMemory::FileInMemory(const char* extension, const std::uint8_t* bytes, std::size_t size) {
  const std::filesystem::path memory = "/dev/shm";
  const auto folder =
      std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
  path_ = (folder / ("swiftlet-fuzz-" + std::to_string(getpid()) + extension)).string();
  std::ofstream(path_, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
}
FileInMemory::~FileInMemory() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace swiftlet::fuzz
