# Everything on a fresh machine that has a Rust toolchain. `make` alone lists the targets.

CARGO ?= cargo
TARGET_DIR := $(or $(CARGO_TARGET_DIR),target)
HOST = $(shell rustc -vV | sed -n 's/^host: //p')

.PHONY: help setup build demo test quick studies memory lint doc wheel tarball package-test

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | expand -t 16

setup: ## install what a build needs, a C++ compiler and Embree 4, and the denoiser if it can be had
	@vendor-bindings/embree4-sys/setup.sh
	@vendor-bindings/oidn/setup.sh || echo "setup: going on without the denoiser: pictures stay noisy" >&2

build: setup ## target/release/lightsplat
	$(CARGO) build --release --locked
	@echo "built $(TARGET_DIR)/release/lightsplat"

demo: build ## render a first scene to out/
	@mkdir -p out
	$(TARGET_DIR)/release/lightsplat render scenes/cornell.toml -o out/cornell.exr
	@echo "rendered out/cornell.exr and out/cornell.png"

test: setup ## every test but studies
	$(CARGO) test --workspace --locked

quick: setup ## the tests that take seconds, not minutes
	$(CARGO) test --workspace --locked -- --skip slow_

studies: setup ## the tests that take many minutes, which `test` leaves out
	$(CARGO) test --workspace --locked -- --ignored

memory: export RUSTC_BOOTSTRAP = 1
memory: export RUSTFLAGS = -Zsanitizer=address
memory: export ASAN_OPTIONS = detect_leaks=0:detect_odr_violation=0
memory: setup ## AddressSanitizer over the tests of rays and shadow rays, in a folder of its own
	CARGO_TARGET_DIR=$(TARGET_DIR)/memory $(CARGO) test -p embree --locked --lib --target $(HOST)
	CARGO_TARGET_DIR=$(TARGET_DIR)/memory $(CARGO) test -p world --locked --lib --target $(HOST) -- shadow::

wheel: ## dist/lightsplat-VERSION-...whl, which pip installs on any x86-64 Linux; takes some minutes
	@packaging/build wheel

tarball: ## dist/lightsplat-VERSION-x86_64-linux.tar.xz, the program and its libraries in one folder
	@packaging/build tarball

package-test: ## make both packages, install them in fresh folders, render from both
	@packaging/build wheel tarball
	python3 packaging/test_packages.py

lint: setup ## format and clippy, warnings denied
	$(CARGO) fmt --all --check
	$(CARGO) clippy --workspace --all-targets --locked -- -D warnings

doc: setup ## the documentation, warnings denied
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --workspace --no-deps --document-private-items --locked
