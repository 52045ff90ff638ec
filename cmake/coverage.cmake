# Target coverage_report: what the tests run so far have reached in the kernel. Their profiles are in <build>/profiles.
find_program(LLVM_PROFDATA llvm-profdata REQUIRED)
find_program(LLVM_COV llvm-cov REQUIRED)
get_property(programs DIRECTORY tests PROPERTY BUILDSYSTEM_TARGETS)
list(FILTER programs INCLUDE REGEX "^test_")
list(REMOVE_ITEM programs test_support)
list(TRANSFORM programs REPLACE ".+" "-object;$<TARGET_FILE:\\0>")
set(report -instr-profile all.profdata $<TARGET_FILE:slideway> ${programs} ${PROJECT_SOURCE_DIR}/kernel)
add_custom_target(coverage_report
  COMMAND ${LLVM_PROFDATA} merge -sparse profiles -o all.profdata
  COMMAND ${LLVM_COV} show -format=html -output-dir=coverage ${report}
  COMMAND ${LLVM_COV} report ${report}
  WORKING_DIRECTORY ${PROJECT_BINARY_DIR} COMMAND_EXPAND_LISTS VERBATIM USES_TERMINAL)
