#!/bin/bash -eu
# What OSS-Fuzz runs (https://google.github.io/oss-fuzz): targets, seeds and dictionaries into $OUT. fmt and toml++ are
# taken as headers, because the packages' libraries are built with another C++ library; MPFR and GMP are C.
cd "$SRC/slideway"
build=$(mktemp -d)
cmake -S . -B "$build" -G Ninja -D SLIDEWAY_TESTS=OFF -D SLIDEWAY_BENCH=OFF -D SLIDEWAY_FUZZ=ON \
  -D fmt_DIR="$PWD/fuzz/headers" -D tomlplusplus_DIR="$PWD/fuzz/headers" \
  -D SLIDEWAY_MPFR="$($CXX -print-file-name=libmpfr.a)" -D SLIDEWAY_GMP="$($CXX -print-file-name=libgmp.a)"
cmake --build "$build" --target fuzzers

for target in hlcp scene step calls command; do
  cp "$build/$target" "$OUT/"
  seeds=(fuzz/corpus/$target)
  [[ $target != scene ]] || seeds+=(scenes)
  [[ $target != command ]] || seeds+=(tests/data/hlcp)
  zip -q -r -j "$OUT/${target}_seed_corpus.zip" "${seeds[@]}"
  [[ ! -f fuzz/$target.dict ]] || cp "fuzz/$target.dict" "$OUT/"
done
