# fathom_compile_shader(TARGET SCENE SHADER_TARGET OUT [DEPENDS files…]): compiles SCENE with `fathom compile` to OUT
# when it or one of the files changes, before TARGET is built. Relative paths are those of the current source and binary
# folders.
function(fathom_compile_shader target scene shader_target out)
  cmake_parse_arguments(PARSE_ARGV 4 arg "" "" "DEPENDS")
  get_filename_component(scene "${scene}" ABSOLUTE)
  get_filename_component(out "${out}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_BINARY_DIR}")
  add_custom_command(
    OUTPUT "${out}"
    COMMAND Fathom::fathom compile "${scene}" --target "${shader_target}" -o "${out}"
    DEPENDS "${scene}" ${arg_DEPENDS}
    COMMENT "Compiling ${scene} to ${shader_target}"
    VERBATIM)
  target_sources(${target} PRIVATE "${out}")
endfunction()
