# make demo    the main job, end to end, on a rendered cell: the files are named at the end
# make test    all tests, lint and types
# make zip     the Blender extension, in dist/
PYTHON ?= $(shell command -v python3.11 || command -v python3)
OUT ?= out/demo
JOBS ?= 2
VENV := .venv
RUN := $(VENV)/bin
OPENCV := opencv-python-headless==4.11.0.86
RUAMEL := ruamel.yaml==0.19.1

# Blender's own builder of extensions, which its Python module brings along
BUILDER := $(VENV)/lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py

.PHONY: demo test lint zip clean

demo: $(VENV)/installed
	$(RUN)/monocell demo $(OUT)

# whole files side by side: windows mostly wait. The wheels first, or two would fetch them at once
test: $(VENV)/installed lint
	-$(MAKE) --no-print-directory wheels/downloaded
	$(RUN)/python -m pytest -n $(JOBS) --dist loadfile

lint: $(VENV)/installed
	$(RUN)/ruff check .
	$(RUN)/ruff format --check .
	$(RUN)/python -m mypy core

# wheels for the Python of any Blender: the abi3 one of OpenCV, the pure one of ruamel.yaml
wheels/downloaded: blender_manifest.toml
	$(PYTHON) -m pip download --quiet --no-deps --only-binary=:all: --python-version 3.13 \
	  --platform manylinux2014_x86_64 --platform manylinux_2_28_x86_64 --abi abi3 --abi none \
	  --dest wheels $(OPENCV) $(RUAMEL)
	touch $@

zip: $(VENV)/installed wheels/downloaded
	mkdir -p dist
	$(RUN)/python $(BUILDER) build --source-dir . --output-filepath dist/monocell.zip --valid-tags ""

$(VENV)/installed: pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(RUN)/python -m pip install --quiet --upgrade pip
	$(RUN)/python -m pip install --quiet --constraint constraints.txt --editable '.[blender,robot,dev]'
	touch $@

clean:
	rm -rf $(VENV) out dist build wheels *.egg-info
