// Built from client/src by client/build.js; change that instead.
"use strict";(()=>{var CAMERA_KEYS={ArrowLeft:"left",ArrowRight:"right",ArrowUp:"up",ArrowDown:"down","+":"closer","=":"closer","-":"farthe\
r",_:"farther",0:"whole"},PLAY_KEY=" ",FULLSCREEN_KEY="f",CLOSE_KEY="Escape";function hasModifier(event){return event.ctrlKey||event.metaKey||event.altKey}function toggleFullscreen(element){document.
fullscreenElement?document.exitFullscreen():element.requestFullscreen?.().catch(()=>{})}function throttled(later,wait,call){let next=null,running=!1,run=()=>{if(running=next!==null,!next)return;let{value}=next;
next=null,call(value),later(run,wait)};return value=>{next={value},running||run()}}function clamp(x,low,high){return Math.min(Math.max(x,low),high)}function placeIn(element,event){let box=element.getBoundingClientRect();return{x:2*(event.clientX-box.left)/Math.max(box.
width,1)-1,y:1-2*(event.clientY-box.top)/Math.max(box.height,1)}}function loadFiles(address,partsOfFile){return async(key,steps,signal)=>{let name=address()+[String(key??"whole"),...steps].
join("."),answer=await fetch(name,{signal});if(!answer.ok)throw new Error(`${name}: ${answer.status}`);return partsOfFile(
await answer.arrayBuffer())}}var vue=()=>window.Vue;var MESSAGE_MS=100,PROPS=["source","settings","camera","time","playing"],isEqual=(a,b)=>JSON.stringify(a)===JSON.stringify(
b),slowly=call=>throttled(setTimeout,MESSAGE_MS,call),BrowserView=class{props;emit;client=null;viewer=null;lastCamera=null;lastTime=NaN;isDisposed=!1;started=0;load=loadFiles(
()=>this.props.source.parts,file=>this.client?.partsOfFile(file)??[]);watcher=new MutationObserver(()=>this.look());constructor(props,emit){
this.props=props,this.emit=emit}async begin(element){let address=new URL(this.props.source.client,document.baseURI).href;
if(this.client=await import(address),this.isDisposed)return;let viewer=new this.client.Viewer(element,this.options());this.
viewer=viewer,viewer.root.style.height="100%",this.watcher.observe(viewer.root,{attributeFilter:["data-sharp"]}),await this.
show()}options(){let{emit}=this,sendCamera=slowly(camera=>emit("update:camera",camera)),sendTime=slowly(time=>emit("upda\
te:time",time));return{rebuild:!0,controls:!1,bare:!0,onCamera:camera=>sendCamera(this.lastCamera=camera),onTime:time=>sendTime(
this.lastTime=time),onPlaying:playing=>emit("update:playing",playing),onPoint:({index,position})=>emit("point",this.viewer?.
header?.geometry.triangles?position:[...index]),onSetting:(name,value)=>emit("setting",[name,value]),source:{load:this.load,
hasSteps:!0}}}async show(){let{source,playing}=this.props;this.started=performance.now(),this.viewer?.setHeader(source.header);
for(let part of await this.load(null,[]))this.isDisposed||this.viewer?.setPart(part);playing&&this.viewer?.play()}look(){
let now=performance.now();this.viewer?.sharp?this.emit("sharp",now-this.started):this.started=now}take(name){let{viewer,
lastCamera,lastTime}=this,{settings,camera,time,playing}=this.props;if(!viewer)return;({source:()=>{this.show()},settings:()=>viewer.
setSettings(settings),camera:()=>camera&&!isEqual(camera,lastCamera)&&viewer.setCamera(camera),time:()=>time!==lastTime&&
!viewer.playing&&viewer.setTime(time),playing:()=>playing?viewer.play():viewer.pause()})[name]()}dispose(){this.isDisposed=
!0,this.watcher.disconnect(),this.viewer?.dispose()}},browser={name:"flowtex-client",props:PROPS,emits:["update:camera",
"update:time","update:playing","setting","sharp","point","hover"],setup(props,{emit}){let{h,ref,watch,onMounted,onBeforeUnmount}=vue(),
place=ref(null),view=new BrowserView(props,emit);onMounted(()=>place.value&&void view.begin(place.value)),onBeforeUnmount(
()=>view.dispose());let follow=name=>watch(()=>props[name],()=>view.take(name));PROPS.forEach(follow);let sendHover=slowly(
at=>emit("hover",at)),onPointermove=event=>{if(!place.value)return;let{x,y}=placeIn(place.value,event);sendHover(event.buttons?
null:[x,y])},onPointerleave=()=>sendHover(null);return()=>h("div",{ref:place,onPointermove,onPointerleave})}};var PANELS=".flowtex-title, .flowtex-buttons, .flowtex-panel, .flowtex-corner, .flowtex-player",CORNER_PX=200,GAP_PX=4;function coverOf(panel,whole){
let{left,top,right,bottom,width}=panel.getBoundingClientRect();if(!width)return null;let end=panel.matches(".flowtex-cor\
ner")?Math.min(right,left+CORNER_PX):right,foot=panel.matches(".flowtex-panel")?whole.bottom:bottom,share=(edge,start,size)=>Number(
clamp((edge-start)/size,0,1).toFixed(4));return[share(left-GAP_PX,whole.left,whole.width),share(top-GAP_PX,whole.top,whole.
height),share(end+GAP_PX,whole.left,whole.width),share(foot+GAP_PX,whole.top,whole.height)]}var covers={name:"flowtex-co\
vers",emits:["change"],setup(_,{emit}){let{h,ref,onMounted,onBeforeUnmount}=vue(),place=ref(null),last="",look=()=>{let page=place.
value?.parentElement;if(!page?.clientWidth||!page.clientHeight)return;let whole=page.getBoundingClientRect(),player=page.
querySelector(".flowtex-player")?.getBoundingClientRect();player&&page.style.setProperty("--foot",`${whole.bottom-player.
top}px`);let present=[...page.querySelectorAll(PANELS)].map(panel=>coverOf(panel,whole)).filter(cover=>cover!==null);JSON.
stringify(present)!==last&&(last=JSON.stringify(present),emit("change",present))},watcher=new ResizeObserver(look);return onMounted(
()=>{let page=place.value?.parentElement;if(page)for(let element of[page,...page.querySelectorAll(PANELS)])watcher.observe(
element)}),onBeforeUnmount(()=>watcher.disconnect()),()=>h("div",{ref:place,hidden:!0})}};var DELAY_MS=400,GAP_PX2=10;function put(box,owner){let at=owner.getBoundingClientRect(),{offsetWidth:width,offsetHeight:height}=box,
middle=[at.left+(at.width-width)/2,at.top+(at.height-height)/2],below=[middle[0],at.bottom+GAP_PX2],above=[middle[0],at.
top-height-GAP_PX2],places={start:[at.left-width-2*GAP_PX2,middle[1]],end:[at.right+2*GAP_PX2,middle[1]],top:above},[left,
top]=places[owner.dataset.side??""]??below;(left<0||left+width>innerWidth)&&([left,top]=below),top+height>innerHeight&&([
left,top]=above),box.style.left=`${clamp(left,4,innerWidth-width-4)}px`,box.style.top=`${Math.max(top,4)}px`}var Hint=class{box;owner=null;timer=0;byKeyboard=!1;constructor(box){
this.box=box}show(owner){this.box.textContent=owner.dataset.hint??"",this.box.hidden=!this.box.textContent,put(this.box,
owner)}hide=event=>{event&&(this.byKeyboard=event.type==="keydown"),clearTimeout(this.timer),this.box.hidden=!0};scroll=()=>{
this.box.hidden=!0};leave=()=>{this.hide(),this.owner=null};take(target,delay){let owner=target instanceof Element?target.
closest("[data-hint]"):null;owner===this.owner&&owner||(this.leave(),this.owner=owner,owner&&(this.timer=window.setTimeout(
()=>this.show(owner),delay)))}point=event=>{event.pointerType!=="touch"&&this.take(event.target,DELAY_MS)};focus=event=>{
this.byKeyboard&&this.take(event.target,0)}},hints={name:"flowtex-hints",setup(){let{h,ref,onMounted,onBeforeUnmount}=vue(),
place=ref(null),ended=new AbortController;return onMounted(()=>{if(!place.value)return;let hint=new Hint(place.value),options={
signal:ended.signal,capture:!0};window.addEventListener("pointerover",hint.point,options),window.addEventListener("focus\
in",hint.focus,options);for(let name of["focusout","blur"])window.addEventListener(name,hint.leave,options);for(let name of[
"pointerdown","keydown"])window.addEventListener(name,hint.hide,options);window.addEventListener("scroll",hint.scroll,options),
document.documentElement.addEventListener("pointerleave",hint.leave,{signal:ended.signal})}),onBeforeUnmount(()=>ended.abort()),
()=>h("div",{ref:place,role:"tooltip",class:"flowtex-tooltip",hidden:!0})}};var COMMANDS={...CAMERA_KEYS,d:"detail",".":"next",",":"previous"},TOGGLES={[PLAY_KEY]:"play",[CLOSE_KEY]:"close",t:"the\
me","?":"help"},OWNERS="input, textarea, select, [contenteditable], [role=slider], .v-overlay--active";function press(event,emit){
let{target,key}=event,isClose=key===CLOSE_KEY;if(!hasModifier(event)&&!(!isClose&&target instanceof Element&&target.closest(
OWNERS))&&!(key===PLAY_KEY&&target instanceof HTMLButtonElement)){if(key===FULLSCREEN_KEY)toggleFullscreen(document.documentElement);else if(key in
COMMANDS)emit("command",COMMANDS[key]);else if(key in TOGGLES)emit("toggle",TOGGLES[key]);else return;isClose||event.preventDefault()}}
var keys={name:"flowtex-keys",emits:["command","toggle","linked"],setup(_,{emit}){let onKeyDown=event=>press(event,emit);
return vue().onMounted(()=>{window.addEventListener("keydown",onKeyDown),window.location.hash.length>1&&emit("linked",window.
location.hash)}),vue().onBeforeUnmount(()=>window.removeEventListener("keydown",onKeyDown)),()=>null}};var HEAD={apart:90,length:14,half:5},POINT_RADIUS=6,FREE_RADIUS=20,textOf=line=>line.map(place=>place.map(v=>v.toFixed(1)).
join()).join(" ");function arrowHeads(line,apart=HEAD.apart){let heads=[],due=0;for(let n=line.length-1;n>0;n-=1){let[[ax,
ay],[bx,by]]=[line[n-1],line[n]],size=Math.hypot(bx-ax,by-ay);if(!size)continue;let[ux,uy]=[(bx-ax)/size,(by-ay)/size];for(;due<
size;due+=apart){let[x,y]=[bx-due*ux,by-due*uy],[left,low]=[x-HEAD.length*ux,y-HEAD.length*uy],[wide,tall]=[-HEAD.half*uy,
HEAD.half*ux];heads.push([[x,y],[left+wide,low+tall],[left-wide,low-tall]])}due-=size}return heads}function pathShapes({
path:path2,sampled,point,directed,dots=[]}){let lines=(all,kind)=>all.map(line=>["polyline",{class:kind,points:textOf(line)}]),
isFree=([[x,y]])=>!point||Math.hypot(x-point[0],y-point[1])>FREE_RADIUS,heads=directed?path2.flatMap(line=>arrowHeads(line)).
filter(isFree):[],ring=kind=>point?[["circle",{class:kind,cx:point[0],cy:point[1],r:POINT_RADIUS}]]:[];return[...lines(path2,
"whole-casing"),...lines(path2,"whole"),...lines(sampled,"casing"),...lines(sampled,"sampled"),...heads.map(head=>["poly\
gon",{class:"arrow",points:textOf(head)}]),...dots.map(({place:[cx,cy],radius,grey})=>{let fill=`rgb(${[grey,grey,grey].
map(x=>Math.round(255*x)).join()})`;return["circle",{class:"dot",cx,cy,r:radius,fill}]}),...ring("point-casing"),...ring(
"point")]}var INSET={width:232,height:112,margin:9},DOT={least:1.5,most:4.5},POINT_RADIUS2=6;function polyline(line,kind,mapping){
let points=line.map(place=>mapping(place).map(v=>v.toFixed(1)).join(",")).join(" ");return vue().h("polyline",{class:kind,
points})}function circle([cx,cy],r,attributes){return vue().h("circle",{cx,cy,r,...attributes})}function pane(over,number,width,height){
let{h}=vue(),mapping=([x,y])=>[(number+(x+1)/2)*width,(1-y)/2*height],lines=all=>all.map(line=>line.map(mapping)),{path:whole,
sampled,directed}=over,point=over.point&&mapping(over.point),marks=pathShapes({path:lines(whole),sampled:lines(sampled),
point,directed}).map(([tag,attributes])=>h(tag,attributes)),id=`flowtex-pane-${number}`,clip=h("clipPath",{id},h("rect",
{x:number*width,y:0,width,height}));return h("g",{"clip-path":`url(#${id})`},[clip,...marks])}var path={name:"flowtex-pa\
th",props:["over"],setup(props){let{h,ref,onMounted,onBeforeUnmount}=vue(),place=ref(null),size=ref([1,1]),watcher=new ResizeObserver(
([{contentRect}])=>{size.value=[contentRect.width,contentRect.height]});return onMounted(()=>place.value&&watcher.observe(
place.value)),onBeforeUnmount(()=>watcher.disconnect()),()=>{let{over}=props;if(!over)return h("div",{ref:place});let[width,
height]=size.value,wide=width/over.panes,panes=over.shown.map(n=>pane(over,n,wide,height));return h("div",{ref:place},h(
"svg",panes))}}};function fitting(places,aspect){let{width:wide,height:high,margin}=INSET,flat=([x,y])=>[x*aspect,-y],flattened=places.
map(flat),[xs,ys]=[0,1].map(k=>flattened.map(place=>place[k])),[left,top]=[Math.min(...xs),Math.min(...ys)],[width,height]=[
Math.max(...xs)-left,Math.max(...ys)-top],ratios=[(wide-2*margin)/(width||1e-9),(high-2*margin)/(height||1e-9)],scale=Math.
min(...ratios);return place=>{let[x,y]=flat(place);return[wide/2+(x-left-width/2)*scale,high/2+(y-top-height/2)*scale]}}
function enlarged({samples,sampled,point,aspect}){let{h}=vue(),places=samples.map(({x,y})=>[x,y]),mapping=fitting(places,
aspect),centres=places.map(mapping),lines=sampled.map(line=>polyline(line,"sampled",mapping)),dots=samples.map(({weight,
grey},n)=>{let[cx,cy]=centres[n],[nx,ny]=centres[n>0?n-1:1]??[cx+DOT.most,cy+DOT.most],most=clamp(.75*Math.hypot(nx-cx,ny-
cy),DOT.least,DOT.most);return circle([cx,cy],most*(.35+.65*weight),{fill:grey})});point&&dots.push(circle(mapping(point),
POINT_RADIUS2,{class:"point"}));let{width,height}=INSET;return h("svg",{viewBox:`0 0 ${width} ${height}`,width,height},[
...lines,...dots])}var inset={name:"flowtex-inset",props:["over"],setup(props){return()=>vue().h("div",props.over?.samples.
length?[enlarged(props.over)]:[])}};async function send(file,address){let query=new URLSearchParams({name:file.name});try{let answer=await fetch(`${address}\
?${query.toString()}`,{method:"POST",body:file});return answer.ok?"":await answer.text()}catch{return`${file.name}: coul\
d not be sent`}}var upload={name:"flowtex-upload",props:["address","accept"],emits:["problem","busy"],setup(props,{emit}){
let{h,ref,onMounted,onBeforeUnmount}=vue(),isOver=ref(!1),input=ref(null),ended=new AbortController,take=async files=>{for(let file of files??
[]){emit("busy",`Sending ${file.name}`);let problem=await send(file,props.address);emit("busy",""),problem&&emit("proble\
m",problem)}},hasFiles=({dataTransfer})=>dataTransfer?.types.includes("Files")??!1,over=event=>{hasFiles(event)&&(event.
preventDefault(),isOver.value=!0)},leave=event=>{event.relatedTarget||(isOver.value=!1)},drop=event=>{isOver.value=!1,hasFiles(
event)&&(event.preventDefault(),take(event.dataTransfer?.files))};onMounted(()=>{let options={signal:ended.signal};window.
addEventListener("dragover",over,options),window.addEventListener("dragleave",leave,options),window.addEventListener("dr\
op",drop,options)}),onBeforeUnmount(()=>ended.abort());let change=()=>{take(input.value?.files).then(()=>input.value&&(input.
value.value=""))},choose={ref:input,type:"file",accept:props.accept,onChange:change,hidden:!0};return()=>h("div",{class:"\
flowtex-upload"},[h("input",{...choose,"aria-label":"A file of yours"}),h("button",{class:"flowtex-link",onClick:()=>input.
value?.click()},"Open a file of yours"),h("div",{class:"flowtex-drop",hidden:!isOver.value},`Drop it here: ${props.accept}`)])}};function linked(hash){let folder=new URL(".",document.baseURI),secret=sessionStorage.getItem(`flowtex ${folder.pathname}\
 secret`);return secret&&(folder.search=new URLSearchParams({secret}).toString()),folder.href+hash}Object.assign(window,
{flowtex_page:{install(app){for(let component of[browser,covers,hints,inset,keys,path,upload])app.component(component.name,
component);Object.assign(app.config.globalProperties,{flowtex_fullscreen:()=>toggleFullscreen(document.documentElement),
flowtex_address:linked,flowtex_copy:text=>navigator.clipboard?.writeText(text)})}}});})();
