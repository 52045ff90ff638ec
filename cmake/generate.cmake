# Sources that the build writes, all below <build>/generated.
set(SLIDEWAY_GENERATED ${PROJECT_BINARY_DIR}/generated)

# slideway_embed(TARGET NAME FILE...): TARGET may include <slideway/embedded/NAME.hpp>, where
# slideway::embedded::NAME is an array of {file name, text} pairs of string views, in the order given.
function(slideway_embed target name)
  set(header ${SLIDEWAY_GENERATED}/slideway/embedded/${name}.hpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed.cmake)
  add_custom_command(OUTPUT ${header}
    COMMAND ${CMAKE_COMMAND} -D NAME=${name} -D HEADER=${header} "-DFILES=${ARGN}" -P ${script}
    DEPENDS ${ARGN} ${script} VERBATIM)
  target_sources(${target} PRIVATE ${header})
  target_include_directories(${target} PRIVATE ${SLIDEWAY_GENERATED})
endfunction()

# slideway_export(SCENE.toml...): whoever links slideway_scenes may include <slideway/scenes/SCENE.hpp>, which
# `slideway export` writes. Copied only if different: a new build of the command compiles nothing again by itself.
function(slideway_export)
  foreach(scene IN LISTS ARGN)
    cmake_path(REPLACE_EXTENSION scene hpp OUTPUT_VARIABLE header)
    set(exported ${SLIDEWAY_GENERATED}/exported/${header})
    set(header ${SLIDEWAY_GENERATED}/slideway/scenes/${header})
    file(MAKE_DIRECTORY ${SLIDEWAY_GENERATED}/exported ${SLIDEWAY_GENERATED}/slideway/scenes)
    add_custom_command(OUTPUT ${header}
      COMMAND slideway export scenes/${scene} -o ${exported}
      COMMAND ${CMAKE_COMMAND} -E copy_if_different ${exported} ${header}
      DEPENDS slideway ${PROJECT_SOURCE_DIR}/scenes/${scene}
      WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(scene_headers DEPENDS ${headers})
  add_library(slideway_scenes INTERFACE)
  target_include_directories(slideway_scenes INTERFACE ${SLIDEWAY_GENERATED})
  target_link_libraries(slideway_scenes INTERFACE slideway::slideway)
  add_dependencies(slideway_scenes scene_headers)
endfunction()
