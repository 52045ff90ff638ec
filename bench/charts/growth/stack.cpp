#include "stack.hpp"

#include <pthread.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <stdexcept>

namespace slideway::charts {
namespace {

constexpr std::size_t stack_room = std::size_t{16} << 20, page = 4096;  // bytes
constexpr unsigned char untouched = 0xa5;

void* call_it(void* call) {
  (*static_cast<const std::function<void()>*>(call))();
  return nullptr;
}

struct Free {
  void operator()(unsigned char* memory) const { std::free(memory); }
};

std::size_t touched_by(const std::function<void()>& call) {
  const std::unique_ptr<unsigned char, Free> memory(static_cast<unsigned char*>(std::aligned_alloc(page, stack_room)));
  if (!memory) throw std::bad_alloc();
  std::fill_n(memory.get(), stack_room, untouched);
  pthread_attr_t attributes;
  pthread_t thread;
  pthread_attr_init(&attributes);
  const bool made = pthread_attr_setstack(&attributes, memory.get(), stack_room) == 0 &&
                    pthread_create(&thread, &attributes, call_it, const_cast<std::function<void()>*>(&call)) == 0;
  pthread_attr_destroy(&attributes);
  if (!made) throw std::runtime_error("no thread to measure a stack in");
  pthread_join(thread, nullptr);
  // It grows downwards: what is touched lies at the end.
  const unsigned char* end = memory.get() + stack_room;
  return static_cast<std::size_t>(
      end - std::find_if(memory.get(), memory.get() + stack_room, [](unsigned char c) { return c != untouched; }));
}

}  // namespace

std::size_t stack_of(const std::function<void()>& call) {
  touched_by(call);  // the first time the loader may have symbols to find, on the same stack
  return touched_by(call) - touched_by([] {});
}

}  // namespace slideway::charts
