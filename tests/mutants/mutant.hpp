// What the copy of the kernel that `generate` writes asks at every place that it can change. -include brings it.
#pragma once

namespace slideway_mutant {

struct Number {  // a class, since only those are made before others' globals
  int value;
};

extern const Number active;  ///< the mutant that is switched on, by the environment's SLIDEWAY_MUTANT; 0: none
extern bool reached[];       ///< by number: was the place passed at run time?

inline bool here(int number) noexcept {
  reached[number] = true;
  return number == active.value;
}

}  // namespace slideway_mutant

// What the compiler evaluates stays as it is: the tables of compile-time scenes.
#define SLIDEWAY_MUTANT(number) (!__builtin_is_constant_evaluated() && slideway_mutant::here(number))
