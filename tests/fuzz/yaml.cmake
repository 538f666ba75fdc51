# The save format's fuzz target; included by CMakeLists.txt where FATHOM_FUZZ is on.
add_executable(yaml_fuzz yaml_fuzz.cpp)
target_compile_options(yaml_fuzz PRIVATE -fsanitize=fuzzer)
target_link_options(yaml_fuzz PRIVATE -fsanitize=fuzzer)
target_link_libraries(yaml_fuzz PRIVATE fathom_save-format)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/yaml_corpus)
add_test(NAME fuzz_yaml
         COMMAND yaml_fuzz -max_total_time=60 -max_len=4096 -timeout=10 -dict=${CMAKE_CURRENT_SOURCE_DIR}/yaml.dict
                 ${CMAKE_BINARY_DIR}/yaml_corpus ${CMAKE_CURRENT_SOURCE_DIR}/yaml_seeds)
