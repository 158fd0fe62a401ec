# Everything on a fresh machine that has a Rust toolchain. `make` alone lists the targets.

CARGO ?= cargo
TARGET_DIR := $(or $(CARGO_TARGET_DIR),target)
HOST = $(shell rustc -vV | sed -n 's/^host: //p')

.PHONY: help setup build demo test quick studies memory lint doc wheel tarball package-test

help: ## print this list
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | expand -t 16

setup: ## install what a build needs: a C++ compiler, Embree 4 and, if possible, the denoiser
	@vendor-bindings/embree4-sys/setup.sh
	@vendor-bindings/oidn/setup.sh || echo "setup: continuing without the denoiser, so images stay noisy" >&2

build: setup ## build target/release/lightsplat
	$(CARGO) build --release --locked
	@echo "built $(TARGET_DIR)/release/lightsplat"

demo: build ## render a first scene to out/
	@mkdir -p out
	$(TARGET_DIR)/release/lightsplat render scenes/cornell.toml -o out/cornell.exr
	@echo "rendered out/cornell.exr and out/cornell.png"

test: setup ## run all tests except the studies
	$(CARGO) test --workspace --locked

quick: setup ## run the tests that take seconds
	$(CARGO) test --workspace --locked -- --skip slow_

studies: setup ## run the tests that take many minutes
	$(CARGO) test --workspace --locked -- --ignored

memory: export RUSTC_BOOTSTRAP = 1
memory: export RUSTFLAGS = -Zsanitizer=address
memory: export ASAN_OPTIONS = detect_leaks=0:detect_odr_violation=0
memory: setup ## run the tests of rays with AddressSanitizer, in a separate folder
	CARGO_TARGET_DIR=$(TARGET_DIR)/memory $(CARGO) test -p embree --locked --lib --target $(HOST)
	CARGO_TARGET_DIR=$(TARGET_DIR)/memory $(CARGO) test -p world --locked --lib --target $(HOST) -- shadow::

wheel: ## build dist/lightsplat-VERSION-...whl, which pip installs on any x86-64 Linux; takes some minutes
	@packaging/build wheel

tarball: ## build dist/lightsplat-VERSION-x86_64-linux.tar.xz, the program and its libraries in one folder
	@packaging/build tarball

package-test: ## make both packages, install them in fresh folders, render from both
	@packaging/build wheel tarball
	python3 packaging/test_packages.py

lint: setup ## check format and clippy; warnings are errors
	$(CARGO) fmt --all --check
	$(CARGO) clippy --workspace --all-targets --locked -- -D warnings

doc: setup ## build the documentation; warnings are errors
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --workspace --no-deps --document-private-items --locked
