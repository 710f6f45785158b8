# `make demo` and `make test` need nothing but a Debian machine: Rust is installed where it is missing.

# The path of the caller, before the tools of the project stand on it.
CALLERS_PATH := $(PATH)
export PATH := $(CURDIR)/.venv/bin:$(or $(CARGO_HOME),$(HOME)/.cargo)/bin:$(PATH)

# The part of the demo: a real one where the folder of real input is there, otherwise our own.
DATA    := $(or $(TOOLPOST_DATA),../shared/data)
PART    ?= $(firstword $(wildcard $(DATA)/cldata/nx/coremill.cls) examples/dome.cls)
MACHINE ?= sinumerik-840d-table-ac
DEMO    := out/$(basename $(notdir $(PART)))

SEED ?= 1

# Where `make install` puts the command: in the folder `bin` of this one.
PREFIX ?= $(HOME)/.local

# The quick profile is compiled within two minutes; `make install` and `make bench` take the fast one.
TOOLPOST := cargo run --quiet --locked --profile quick --package toolpost --

# Where that profile puts the command.
QUICK := $(patsubst $(CURDIR)/%,%,$(or $(CARGO_TARGET_DIR),$(CURDIR)/target)/quick/toolpost)

# What fails stops nothing that does not need it.
MAKEFLAGS += --keep-going

.PHONY: demo install test test-rust test-python freecad tests bench judges judges-long images samples rust python
.PHONY: deny notices studio page test-studio images-studio
.PHONY: lint lint-format lint-rust lint-fuzz lint-docs lint-python lint-studio

## Post a part, prove it, draw it, and say what to do next.
demo: rust page
	@echo "Compiling; the first time this takes some minutes."
	cargo build --locked --profile quick --package toolpost
	@mkdir -p out
	$(TOOLPOST) post $(PART) --machine $(MACHINE) --output $(DEMO).mpf
	@$(TOOLPOST) show $(PART) --output $(DEMO).png > /dev/null
	@echo
	@head -n 24 $(DEMO).mpf
	@echo "..."
	@echo
	@echo "program  $(DEMO).mpf"
	@echo "report   $(DEMO).mpf.report.json"
	@echo "picture  $(DEMO).png"
	@echo
	@echo "What to do next:"
	@echo
	@echo "    make install                         # puts the command toolpost into $(PREFIX)/bin; takes some four minutes"
	@echo "    $(QUICK) machines list   # the machines that it can write for"
	@echo "    $(QUICK) post $(PART) --machine fanuc-table-bc --output $(DEMO).nc"
	@echo "    $(QUICK) studio $(PART) --machine $(MACHINE) --folder $(dir $(PART))   # the same in a window of the browser"

## Put the command toolpost into PREFIX/bin (~/.local/bin), compiled for speed.
install: rust page
	cargo install --locked --path crates/toolpost --root "$(PREFIX)" --no-track --force
	@case ":$(CALLERS_PATH):" in \
	*":$(PREFIX)/bin:"*) ;; \
	*) \
		echo "$(PREFIX)/bin is not on your PATH. Put it there, and write the line into ~/.profile to keep it:"; \
		echo; \
		echo "    export PATH=\"$(PREFIX)/bin:\$$PATH\"" ;; \
	esac

## Every test; those that need an outside judge or real input say so where it is missing, and fail where
## CI=true. Property tests draw the same cases in every run; `make test SEED=2`, or any other whole number,
## draws others. What fails does not stop the rest.
test: test-rust test-python freecad test-studio

test-rust: rust
	PROPTEST_RNG_SEED=$(SEED) PROPTEST_DISABLE_FAILURE_PERSISTENCE=1 \
		cargo test --locked --workspace --no-fail-fast

test-python: python
	pytest --quiet --hypothesis-seed $(SEED)

## The tests within FreeCAD (`scripts/setup freecad`), with the command as cargo has built it.
freecad: python
	cargo build --quiet --locked --bin toolpost
	PATH="$(or $(CARGO_TARGET_DIR),$(CURDIR)/target)/debug:$$PATH" pytest --quiet integrations/freecad/tests

## The page of `toolpost studio`, which cargo builds into the command from then on.
studio: studio/dist/index.html

PAGE := $(shell find studio/src examples studio/index.html studio/package-lock.json studio/vite.config.ts studio/licences.ts -type f)

studio/dist/index.html: $(PAGE)
	@scripts/setup page
	@rm -rf studio/dist/assets studio/dist/index.html studio/dist/licences.txt
	npm --prefix studio run --silent build

# For whoever wants the command: without Node it is built all the same, and `toolpost studio` says what it lacks.
page:
	@$(MAKE) --no-print-directory studio || \
		echo "The command is built without the page of \`toolpost studio\`, which needs Node."

## The tests of the page: its parts, and the whole in Debian's Chromium, with the command as cargo has built it.
test-studio: rust studio
	@scripts/setup browser
	cargo build --quiet --locked --bin toolpost
	NO_COLOR=1 npm --prefix studio run --silent test

## The tests in Rust, compiled and not run.
tests: rust
	cargo test --locked --workspace --no-run

## Speed and memory, each with a floor from the same run.
bench: rust
	cargo run --quiet --locked --release --package toolpost-bench -- \
		--machine sinumerik-840d-table-ac --machine sinumerik-840d-traori \
		--machine dmu50-heidenhain --machine fanuc-table-bc \
		$(addprefix --board ,$(wildcard $(addprefix $(DATA)/gerber/,a64 kicad/pic_programmer))) \
		$(wildcard $(addprefix $(DATA)/cldata/,makino/* nx/* solidworks/*))

## Format, lints, documentation. The fuzz targets are a workspace of their own.
lint: lint-format lint-rust lint-fuzz lint-docs lint-python lint-studio

lint-format: rust
	cargo fmt --all --check
	cargo fmt --manifest-path fuzz/Cargo.toml --check

lint-rust: rust
	cargo clippy --locked --workspace --all-targets -- -D warnings

# Nothing is linked: any file stands for libFuzzer, which is not compiled then. With the profiles and the folder of the
# main workspace, what it has checked is not checked again.
lint-fuzz: rust
	CUSTOM_LIBFUZZER_PATH=$(CURDIR)/fuzz/Cargo.toml CARGO_TARGET_DIR=$(or $(CARGO_TARGET_DIR),$(CURDIR)/target) \
		cargo --config Cargo.toml clippy --locked --manifest-path fuzz/Cargo.toml -- -D warnings

lint-docs: rust
	RUSTDOCFLAGS="-D warnings" cargo doc --quiet --locked --workspace --no-deps --document-private-items

lint-python: python
	ruff check
	ruff format --check
	mypy
	stubtest toolpost

lint-studio:
	@scripts/setup page
	npm --prefix studio run --silent types
	npm --prefix studio run --silent lint

## The tests with the outside judges, which are installed first.
judges:
	scripts/setup judges
	$(MAKE) test

## The same, and what takes long: a hundred programs on a real LinuxCNC, 2000 damages, other random input each time.
judges-long:
	scripts/setup judges
	TOOLPOST_JUDGES=long $(MAKE) test

## Licences, sources and versions of all crates, the fuzz targets' too, and their known weaknesses where the network reaches
## the database of them.
deny: rust
	scripts/setup deny
	cargo deny --locked check licenses bans sources
	cargo deny --locked --manifest-path fuzz/Cargo.toml --config deny.toml check licenses bans sources
	scripts/advisories

## THIRD-PARTY.md, the terms of the crates that are linked into the command and the Python package, written anew.
notices: rust
	scripts/setup deny
	cargo fetch --locked
	cargo about generate --locked --offline --manifest-path python/Cargo.toml --config scripts/notices/about.toml \
		scripts/notices/notices.hbs --output-file THIRD-PARTY.md

## The pictures of the documentation, drawn anew.
images: rust
	$(TOOLPOST) show examples/dome.cls --output docs/images/dome.png > /dev/null
	@mkdir -p out
	$(TOOLPOST) --quiet wire examples/sector.nc --from fanuc-31i --machine bp-95d --side inside --wire 0.25 \
		--gap 0.02 --thread 12,12 --round-corners --taper 10 --height 30 --uv-height 30 --chord-error 0.02 --select 7 \
		--output out/sector.pts --picture docs/images/wire.png
	$(TOOLPOST) --quiet pcb examples/lamp.toml --machine grbl-3018 --tool 0.3 --passes 3 --picture png \
		--output out/lamp
	@cp out/lamp/front.png docs/images/board.png
	$(TOOLPOST) --quiet post examples/lean.cls --machine sinumerik-840d-table-ac --output out/lean.mpf
	$(TOOLPOST) --quiet show out/lean.mpf --from sinumerik-840d-table-ac --output docs/images/rapid-pieces.png
	$(TOOLPOST) --quiet show examples/lean-one-block.mpf --from sinumerik-840d-table-ac \
		--output docs/images/rapid-one-block.png
	$(TOOLPOST) --quiet show out/lean.mpf --from sinumerik-840d-table-ac --frame machine \
		--output docs/images/rapid-pieces-machine.png
	$(TOOLPOST) --quiet show examples/lean-one-block.mpf --from sinumerik-840d-table-ac --frame machine \
		--output docs/images/rapid-one-block-machine.png

## The pictures of docs/studio.md, by the tests of the page.
images-studio: rust studio
	@scripts/setup browser
	cargo build --quiet --locked --bin toolpost
	TOOLPOST_IMAGES=$(CURDIR)/docs/images npm --prefix studio run --silent test -- --project page images

## The sample programs next to the machines, written anew: to be read before they are committed.
samples: rust
	@mkdir -p out/samples
	@for sample in $(filter-out %.cls,$(wildcard machines/samples/*.*)); do \
		name=$$(basename $${sample%.*}); axes=three-axes; \
		if test -f machines/robots/$$name.toml; then \
			mkdir -p out/samples/robot; named=out/samples/robot/SAMPLEROBOT.$${sample##*.}; \
			$(TOOLPOST) --quiet post machines/samples/robot.cls -m $$name -o $$named || exit; \
			mv $$named out/samples/$$(basename $$sample); \
			continue; \
		fi; \
		if grep -Eq '^extends = "(points|wire-iso)"' machines/$$name.toml; then \
			$(TOOLPOST) --quiet wire examples/sector.nc --from fanuc-31i -m $$name --side inside \
				--wire 0.25 --gap 0.02 --leave 0.03 --thread 15,15 --round-corners --feed 0.1,0.2 \
				-o out/samples/$$(basename $$sample) || exit; \
			continue; \
		fi; \
		grep -q '^\[\[rotary\]\]' machines/$$name.toml && axes=five-axes; \
		$(TOOLPOST) --quiet post machines/samples/$$axes.cls -m $$name \
			-o out/samples/$$(basename $$sample) || exit; \
	done
	@rm -r out/samples/*.report.json out/samples/robot
	@mv out/samples/* machines/samples/

rust:
	@scripts/setup rust

# The Python package in the environment of the tests, as a link to its folder here.
python: rust
	@scripts/setup python
	maturin develop --quiet
